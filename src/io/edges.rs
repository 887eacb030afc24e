//! Lists of edges as text: a line has the two vertices of an edge, counted from 0, and `#` begins a comment.

use super::text::{Lines, Tokens, integer, quoted, without_comment};
use crate::Error;

/// Parses the bytes of a list: two vertex indices an edge. No mesh is asked whether it has them.
///
/// # Errors
/// [`Error::Parse`], which names the line.
pub fn parse_edges(bytes: &[u8]) -> Result<Vec<[u32; 2]>, Error> {
    let mut edges = Vec::new();
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next() {
        let words: Vec<_> = Tokens(without_comment(line)).collect();
        let index = |word| {
            let index = integer(word).and_then(|index| u32::try_from(index).ok());
            index.ok_or_else(|| lines.refuse(format!("expected a vertex index, found {}", quoted(word))))
        };
        match words[..] {
            [] => {}
            [u, v] => edges.push([index(u)?, index(v)?]),
            _ => return Err(lines.refuse(format!("expected 2 vertex indices, found {}", words.len()))),
        }
    }
    Ok(edges)
}
