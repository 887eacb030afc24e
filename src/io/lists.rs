//! Lists as text: of edges, a line with the two vertices of each, counted from 0, or of any numbers; `#` begins a comment.

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

/// Parses the bytes of a list of numbers from 0, such as those of triangles: any of them in a line.
///
/// # Errors
/// [`Error::Parse`], which names the line.
pub fn parse_numbers(bytes: &[u8]) -> Result<Vec<u32>, Error> {
    let mut numbers = Vec::new();
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next() {
        for word in Tokens(without_comment(line)) {
            let number = integer(word).and_then(|number| u32::try_from(number).ok());
            let error = || lines.refuse(format!("expected a number from 0, found {}", quoted(word)));
            numbers.push(number.ok_or_else(error)?);
        }
    }
    Ok(numbers)
}
