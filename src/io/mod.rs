//! Mesh files: one module a format, chosen by the extension.
