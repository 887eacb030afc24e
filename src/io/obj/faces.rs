//! The byte ranges of the faces of an OBJ file, the texture vertices and normals of their corners, and their groups.

use super::lines::continued;
use crate::Mesh;
use crate::io::held::{Corners, Face, Faces, Numbers, line_end, of_corners, range_in};
use crate::io::parsed::Others;
use crate::io::text::{Digits, Lines, Tokens, integer, without_comment};

/// Keywords of lines that apply to all faces after them.
const STATES: [&str; 6] = ["usemtl", "g", "o", "s", "mg", "usemap"];

/// Keywords of the lines that corners refer to.
const REFERRED: [&str; 2] = ["vt", "vn"];

/// The texture vertex and the normal of a corner, counted from 1; 0 for none.
type References = [u32; 2];

/// The texts after the keyword of lines vt or vn, and a number for each, equal for equal texts, set on first use.
type Texts<'a> = Vec<(&'a [u8], Option<u32>)>;

/// The faces of a file that has been read.
pub(in crate::io) fn held_faces<'a>(
    bytes: &'a [u8],
    mesh: &Mesh,
    others: &Others,
    ignored: &[String],
) -> Faces<'a> {
    let mut list = Vec::new();
    let mut texts: [Texts; 2] = Default::default();
    let mut references: [Vec<u32>; 2] = Default::default();
    let mut states = [b"".as_slice(); STATES.len()];
    let (mut groups, mut group) = (Numbers::<Vec<&[u8]>>::default(), None);
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
                let group = *group.get_or_insert_with(|| groups.of(states.as_slice()));
                list.push(Face { bytes: start..end, triangles, group });
                for corner in cut.of_next(triangles) {
                    (0..2).for_each(|kind| references[kind].push(corners[corner][kind]));
                }
            }
            Some(b"vt") => texts[0].push((text, None)),
            Some(b"vn") => texts[1].push((text, None)),
            Some(keyword) => {
                if let Some(state) = STATES.iter().position(|state| state.as_bytes() == keyword) {
                    // A name may contain #, so this takes the whole line.
                    let end = bytes.len() - lines.bytes_left();
                    states[state] = after_keyword(&bytes[start..end]);
                    group = None;
                }
            }
        }
    }
    let (mut attributes, mut known) = (Vec::new(), Vec::new());
    for (kind, name) in REFERRED.into_iter().enumerate() {
        let (texts, mut numbers) = (&mut texts[kind], Numbers::default());
        let key = |reference: u32| {
            // A reference to a line that does not exist is compared by its index.
            let found = texts.get_mut((reference as usize).wrapping_sub(1)).ok_or(reference);
            found.map(|(text, number)| *number.get_or_insert_with(|| numbers.of(*text)))
        };
        if let Some((attribute, references)) = of_corners(mesh, name, &references[kind], ignored, key) {
            attributes.push(attribute);
            known.push((kind, references));
        }
    }
    let write = move |out: &mut Vec<u8>, _: &[&[u8]], triangle: [u32; 3], corners: &[[u32; 3]]| {
        let mut digits = Digits::default();
        out.push(b'f');
        for (k, vertex) in triangle.into_iter().enumerate() {
            out.push(b' ');
            digits.integer(out, u64::from(vertex) + 1);
            let mut references = References::default();
            for ((kind, known), numbers) in known.iter().zip(corners) {
                references[*kind] = known[numbers[k] as usize];
            }
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
        names: STATES.map(str::to_owned).to_vec(),
        groups: groups.into_known(),
        corners: attributes,
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
