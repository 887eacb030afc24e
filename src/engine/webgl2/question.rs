//! What the proxy asks of the engine in the other module. A question goes there as a number, with words; the answer is
//! words.

/// A question to the engine.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Question {
    /// As `Engine::lock`; gives nothing.
    Lock,
    /// As `Engine::iterate`; takes the count.
    Iterate,
    /// The counts of the shaders, as `Census::of_counts` takes them.
    Census,
    /// The counts of the shaders, as `Areas::of_counts` takes them.
    Areas,
    /// As `Engine::triangles`.
    Triangles,
    /// As `Engine::twins`.
    Twins,
    /// As `Engine::settle`; gives nothing.
    Settle,
    /// The counts of the shaders, as `Moved::of_counts` takes them.
    Moved,
    /// As `Engine::track_changes`; gives nothing.
    TrackChanges,
    /// As `Engine::changes`.
    Changes,
    /// The bits of the present positions, after updates.
    Positions,
}

#[cfg(feature = "js-webgl2")]
impl Question {
    const ALL: [Self; 11] = [
        Self::Lock,
        Self::Iterate,
        Self::Census,
        Self::Areas,
        Self::Triangles,
        Self::Twins,
        Self::Settle,
        Self::Moved,
        Self::TrackChanges,
        Self::Changes,
        Self::Positions,
    ];

    /// From its number.
    pub(crate) fn of_number(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|&question| question as u32 == number)
    }
}
