//! Lists as text: edges, one line with two vertex indices from 0 for each, or numbers. `#` begins a comment.

use super::text::{Lines, Tokens, integer, quoted, without_comment};
use crate::Error;

/// Parses a list of edges: a line with two vertex indices for each. Does not check the indices against a mesh.
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
            _ => {
                return Err(lines.refuse(format!(
                    "expected 2 vertex indices with a space between, found {}",
                    words.len()
                )));
            }
        }
    }
    Ok(edges)
}

/// Parses a list of numbers from 0, such as indices of triangles. A line may have any number of them.
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
