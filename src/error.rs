//! The one error type: every variant names the place and says what the user can do.

use crate::EngineKind;

/// Why a mesh, a file or a backend was refused. Nothing has been changed when one is returned.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite. Repair or remove the vertex.
    #[error("vertex {vertex}: coordinate {axis} is {}, not a finite number", number(*value))]
    NonFinite {
        /// Index of the vertex.
        vertex: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// The value found.
        value: f64,
    },
    /// A triangle names a vertex that does not exist. Check the file's indices (are they 0-based?).
    #[error("triangle {triangle}: vertex index {index} is out of range, the mesh has {vertices} vertices")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex index found.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The array of positions, of triangles or of locked edges has a length that is no multiple of what one element takes.
    #[error("{array} has {length} numbers, which is not a multiple of {stride}")]
    RaggedArray {
        /// `positions`, `triangles` or `lockedEdges`.
        array: &'static str,
        /// Its length.
        length: usize,
        /// Numbers per element.
        stride: usize,
    },
    /// New positions are not those of as many vertices as the mesh has. Give 2 or 3 numbers for each of them.
    #[error("positions has {length} numbers, and the vertices of the mesh have {expected}")]
    PositionCount {
        /// How many numbers were given.
        length: usize,
        /// How many there have to be.
        expected: usize,
    },
    /// Other triangles for a file are not as many as it has. Give 3 vertices for each of them.
    #[error("triangles has {length} numbers, and those of the file have {expected}")]
    TriangleCount {
        /// How many numbers were given.
        length: usize,
        /// How many there have to be.
        expected: usize,
    },
    /// More triangles or vertices than 32-bit indices can name. Split the mesh.
    #[error("the mesh has {count} {what}; at most {limit} can be indexed")]
    TooLarge {
        /// `triangles` or `vertices`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// There is not enough memory. Split the mesh, or give back what other sessions hold.
    #[error("up to {bytes} bytes of memory are needed, {}", whose(*limit))]
    OutOfMemory {
        /// How many are needed at most.
        bytes: u64,
        /// How many there are for the whole program, where that is known.
        limit: Option<u64>,
    },
    /// A file could not be understood. The message names the line (1-based) or the byte.
    #[error("{place}: {message}")]
    Parse {
        /// Where, for example `line 17`.
        place: String,
        /// What was expected and what was found.
        message: String,
    },
    /// A file has more bytes than an option allows, or would have once it is unpacked. Raise `max_bytes` if you trust it.
    #[error("the file has more than {limit} bytes, packed or unpacked; {option} sets the limit")]
    FileTooLarge {
        /// Bytes that it may have.
        limit: u64,
        /// The option that says so.
        option: &'static str,
    },
    /// The extension names no format that can be read or written.
    #[error("{path}: unknown format; use one of: {known}")]
    UnknownFormat {
        /// The path given.
        path: String,
        /// The extensions that are known.
        known: &'static str,
    },
    /// A file could not be opened, read or written.
    #[error("{path}: {source}")]
    Io {
        /// The path given.
        path: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// An option has a value that makes no sense.
    #[error("option {option}: {message}")]
    Option {
        /// The option's name.
        option: &'static str,
        /// What is wrong with its value.
        message: String,
    },
    /// The backend asked for is not there (`auto` would have taken another one).
    #[error("backend {backend} is not available: {message}")]
    BackendUnavailable {
        /// Which one.
        backend: EngineKind,
        /// Why.
        message: String,
    },
    /// The backend cannot take this mesh: too large for the device, or coordinates outside the span it
    /// decides exactly. Use `auto` or `cpu`.
    #[error("backend {backend} cannot take this mesh: {message}")]
    BackendLimit {
        /// Which one.
        backend: EngineKind,
        /// Which limit, and by how much.
        message: String,
    },
    /// The device was lost or reported an error in the middle of a run.
    #[error("the device failed: {message}")]
    Device {
        /// What the driver said.
        message: String,
    },
}

/// What there is of memory, in a message.
fn whose(limit: Option<u64>) -> String {
    limit.map_or("more than can be had".to_owned(), |limit| {
        format!(
            "and WebAssembly has {limit} for all meshes: free() sessions that are done, or split the mesh"
        )
    })
}

/// A number in a message.
#[cfg(not(all(target_arch = "wasm32", feature = "js-values")))]
pub(crate) fn number(value: f64) -> String {
    value.to_string()
}

/// As JavaScript writes it: Rust's way would take 15 KB of a module.
#[cfg(all(target_arch = "wasm32", feature = "js-values"))]
pub(crate) fn number(value: f64) -> String {
    js_sys::Number::from(value).to_string_with_radix(10).map_or_else(|_| String::new(), String::from)
}

impl Error {
    /// One word for the kind of error, the same in every release: what a program compares.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NonFinite { .. } => "non-finite",
            Self::IndexOutOfRange { .. } => "index-out-of-range",
            Self::RaggedArray { .. } => "ragged-array",
            Self::PositionCount { .. } => "position-count",
            Self::TriangleCount { .. } => "triangle-count",
            Self::TooLarge { .. } | Self::OutOfMemory { .. } => "too-large",
            Self::Parse { .. } => "parse",
            Self::FileTooLarge { .. } => "file-too-large",
            Self::UnknownFormat { .. } => "unknown-format",
            Self::Io { .. } => "io",
            Self::Option { .. } => "invalid-option",
            Self::BackendUnavailable { .. } => "backend-unavailable",
            Self::BackendLimit { .. } => "backend-limit",
            Self::Device { .. } => "device-failed",
        }
    }
}
