//! The one error type: every variant says what is wrong, where, and what the user can do.

use crate::EngineKind;

/// Why a call refused a mesh, a file or a backend. A call that returns an error has changed nothing.
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
    /// The length of an array of positions, triangles or locked edges is not a multiple of the numbers per element.
    #[error("{array} has {length} numbers, not a multiple of {stride}")]
    RaggedArray {
        /// `positions`, `triangles` or `lockedEdges`.
        array: &'static str,
        /// Its length.
        length: usize,
        /// Numbers per element.
        stride: usize,
    },
    /// The new positions do not fit the number of vertices. Give 2 or 3 numbers for each vertex.
    #[error("positions has {length} numbers, but the vertices of the mesh take {expected}")]
    PositionCount {
        /// How many numbers were given.
        length: usize,
        /// How many are expected.
        expected: usize,
    },
    /// The triangles to write do not fit the number of triangles in the file. Give 3 vertices for each triangle.
    #[error("triangles has {length} numbers, but the triangles of the file take {expected}")]
    TriangleCount {
        /// How many numbers were given.
        length: usize,
        /// How many are expected.
        expected: usize,
    },
    /// More triangles or vertices than 32-bit indices can name. Split the mesh.
    #[error("the mesh has {count} {what}; 32-bit indices allow at most {limit}")]
    TooLarge {
        /// `triangles` or `vertices`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// There is not enough memory. Split the mesh, or free other sessions.
    #[error("up to {bytes} bytes of memory are needed, {}", whose(*limit))]
    OutOfMemory {
        /// An upper bound on the bytes needed.
        bytes: u64,
        /// How many bytes the whole program may use, where that is known.
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
    /// The file has more bytes than an option allows, packed or unpacked. Raise `max_bytes` if you trust the file.
    #[error("the file has more than {limit} bytes, packed or unpacked; {option} sets the limit")]
    FileTooLarge {
        /// How many bytes are allowed.
        limit: u64,
        /// The option that sets the limit.
        option: &'static str,
    },
    /// The extension names no format that can be read or written.
    #[error("{path}: unknown format; use one of: {known}")]
    UnknownFormat {
        /// The path given.
        path: String,
        /// The known extensions.
        known: &'static str,
    },
    /// A file could not be opened, read or written.
    #[error("{path}: {source}")]
    Io {
        /// The path given.
        path: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// An option has an invalid value.
    #[error("option {option}: {message}")]
    Option {
        /// The option's name.
        option: &'static str,
        /// What is wrong with its value.
        message: String,
    },
    /// The requested backend is not available. `auto` would take another one.
    #[error("backend {backend} is not available: {message}")]
    BackendUnavailable {
        /// The backend.
        backend: EngineKind,
        /// Why.
        message: String,
    },
    /// The backend cannot take this mesh: it is too large for the device, or its coordinates span more bits than the
    /// backend decides exactly. Use `auto` or `cpu`.
    #[error("backend {backend} cannot take this mesh: {message}")]
    BackendLimit {
        /// The backend.
        backend: EngineKind,
        /// Which limit, and by how much.
        message: String,
    },
    /// The device was lost or reported an error during a run.
    #[error("the device failed: {message}")]
    Device {
        /// The message of the driver.
        message: String,
    },
    /// Another module of the npm package could not be loaded, or failed.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    #[error("another module failed")]
    Thrown {
        /// What JavaScript gets.
        exception: wasm_bindgen::JsValue,
    },
}

/// The second half of the message of [`Error::OutOfMemory`].
fn whose(limit: Option<u64>) -> String {
    limit.map_or("more than is available".to_owned(), |limit| {
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

/// The same, formatted by JavaScript: Rust's formatter would add 15 KB to the module.
#[cfg(all(target_arch = "wasm32", feature = "js-values"))]
pub(crate) fn number(value: f64) -> String {
    js_sys::Number::from(value).to_string_with_radix(10).map_or_else(|_| String::new(), String::from)
}

impl Error {
    /// A name for the kind of error, for programs to compare. It stays the same in every release.
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
            #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
            Self::Thrown { .. } => "internal",
        }
    }
}
