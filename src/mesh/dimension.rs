//! Plane or space.

/// Whether the mesh lies in the plane or is a surface in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Two numbers per vertex; the flips follow the signed in-circle test.
    Two,
    /// Three numbers per vertex; the flips follow the angle sum and the normal-angle threshold β.
    Three,
}

impl Dimension {
    /// Numbers per vertex: 2 or 3.
    pub fn stride(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}
