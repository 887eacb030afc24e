//! The byte ranges of the faces of an OBJ file, the texture vertices and normals of their corners, and their groups.

use super::lines::continued;
use crate::Mesh;
use crate::io::held::{Corners, Face, Faces, Numbers, line_end, numbered, range_in};
use crate::io::parsed::Others;
use crate::io::text::{Digits, Lines, Tokens, integer, without_comment};

/// Keywords of lines that apply to all faces after them.
const STATES: [&[u8]; 6] = [b"usemtl", b"g", b"o", b"s", b"mg", b"usemap"];

/// The texture vertex and the normal of a corner, counted from 1; 0 for none.
type References = [u32; 2];

/// The texts after the keyword of lines vt or vn, and a number for each, equal for equal texts, set on first use.
type Texts<'a> = Vec<(&'a [u8], Option<u32>)>;

/// The faces of a file that has been read.
pub(in crate::io) fn held_faces<'a>(bytes: &'a [u8], mesh: &Mesh, others: &Others) -> Faces<'a> {
    let mut list = Vec::new();
    let mut texts: [Texts; 2] = Default::default();
    let mut references: Vec<References> = Vec::new();
    let (mut states, mut names) = ([None; STATES.len()], Numbers::default());
    let (mut groups, mut group) = (Numbers::default(), None);
    let (mut corners, mut cut) = (Vec::<References>::new(), Corners::new(others));
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next() {
        let (joined, last) = continued(without_comment(line), &mut lines);
        let start = range_in(bytes, line.trim_ascii_start()).start;
        let end = range_in(bytes, last.trim_ascii_end()).end;
        let text = after_keyword(&bytes[start..end.max(start)]);
        let mut tokens = Tokens(&joined);
        match tokens.next() {
            Some(b"v") | None => {}
            Some(b"f" | b"fo") => {
                corners.clear();
                corners.extend(tokens.map(|corner| resolved(corner, &texts)));
                let triangles = corners.len().saturating_sub(2);
                let group = *group.get_or_insert_with(|| groups.of(&states));
                list.push(Face { bytes: start..end, triangles, group });
                references.extend(cut.of_next(triangles).map(|corner| corners[corner]));
            }
            Some(b"vt") => texts[0].push((text, None)),
            Some(b"vn") => texts[1].push((text, None)),
            Some(keyword) => {
                if let Some(state) = STATES.iter().position(|&state| state == keyword) {
                    // A name may contain #, so this takes the whole line.
                    let end = bytes.len() - lines.bytes_left();
                    states[state] = Some(names.of(&after_keyword(&bytes[start..end])));
                    group = None;
                }
            }
        }
    }
    let mut numbers = Numbers::default();
    let value = |references: References| {
        [0, 1].map(|kind| {
            let index = (references[kind] as usize).wrapping_sub(1);
            // A reference to a line that does not exist is compared by its index.
            let found = texts[kind].get_mut(index).ok_or(references[kind]);
            found.map(|(text, number)| *number.get_or_insert_with(|| numbers.of(text)))
        })
    };
    if references.iter().all(|corner| *corner == [0, 0]) {
        references.clear();
    }
    let (corners, known) = numbered(mesh, &references, value);
    let write = move |out: &mut Vec<u8>, _: u32, triangle: [u32; 3], corners: [u32; 3]| {
        let mut digits = Digits::default();
        out.push(b'f');
        for (vertex, corner) in triangle.into_iter().zip(corners) {
            out.push(b' ');
            digits.integer(out, u64::from(vertex) + 1);
            let references = known.get(corner as usize).copied().unwrap_or_default();
            let parts = references.iter().rposition(|&reference| reference > 0).map_or(0, |last| last + 1);
            for &reference in &references[..parts] {
                out.push(b'/');
                if reference > 0 {
                    digits.integer(out, reference.into());
                }
            }
        }
        Ok(())
    };
    Faces {
        lists: vec![list],
        corners,
        counts: Vec::new(),
        separator: line_end(bytes),
        write: Box::new(write),
    }
}

fn after_keyword(line: &[u8]) -> &[u8] {
    let mut words = Tokens(line);
    words.next();
    words.0.trim_ascii()
}

/// The references of a corner such as `1/2/3`; 0 for a missing one.
fn resolved(corner: &[u8], texts: &[Texts; 2]) -> References {
    let mut parts = corner.split(|&b| b == b'/').skip(1);
    texts.each_ref().map(|texts| {
        let number = parts.next().and_then(integer).unwrap_or_default();
        let so_far = texts.len() as i64;
        u32::try_from(if number < 0 { so_far + 1 + number } else { number }).unwrap_or_default()
    })
}
