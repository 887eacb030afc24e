//! STL, the format of stereolithography, text or binary: triangles, each with its own three positions. Corners at the
//! same position become one vertex. Vertices are numbered in the order of their first corners. Source: 3D Systems,
//! "StereoLithography Interface Specification", 1988.

use super::coordinates::{self, Float, Reading};
use super::held::{Face, Faces, Numbers};
use super::options::Coordinates;
use super::parsed::{CutFaces, Dropped, Parsed};
use super::rounded::rounded;
use super::text::{Lines, Tokens, float, quoted};
use crate::{Dimension, Error, MAX_TRIANGLES, Mesh, Positions};
use glam::{DVec3, Vec3};
use std::io::{self, Write};

/// Bytes before the first facet of a binary file: a comment, and the number of facets.
const HEADER: usize = 84;
/// Bytes of a facet: its normal and its corners, 3 numbers each, and an attribute.
const FACET: usize = 50;
/// The offset of the attribute in a facet.
const ATTRIBUTE: usize = 48;

/// Reads a file's bytes.
pub(super) fn parse(bytes: &[u8], option: Option<Coordinates>) -> Result<Parsed, Error> {
    if is_held(bytes) {
        return binary(bytes);
    }
    coordinates::read(option, |asks| text::<f32>(bytes, asks), || text::<f64>(bytes, false))
}

/// Whether the file can be written again with other triangles: it is binary.
pub(super) fn is_held(bytes: &[u8]) -> bool {
    !is_text(&bytes[..bytes.len().min(HEADER)], bytes.len())
}

/// Writes `mesh` in the binary form, rounded to 32-bit floats. z is 0 in a 2D mesh. The normal of a triangle without
/// area is 0.
pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let points = rounded(mesh, "STL")?;
    let mut header = [0; HEADER];
    header[..8].copy_from_slice(b"edgeflip");
    header[80..].copy_from_slice(&(mesh.triangle_count() as u32).to_le_bytes());
    out.write_all(&header)?;
    for triangle in mesh.triangles().as_chunks::<3>().0 {
        out.write_all(&bytes_of(triangle.map(|v| Vec3::from(points[v as usize])), [0, 0]))?;
    }
    Ok(())
}

/// A facet of a binary file with its attribute.
fn bytes_of(corners: [Vec3; 3], attribute: [u8; 2]) -> [u8; FACET] {
    let [a, b, c] = corners.map(DVec3::from);
    // For 32-bit coordinates, the cross product neither overflows nor underflows in 64 bits.
    let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
    let mut facet = [0; FACET];
    for (bytes, point) in facet.chunks_exact_mut(12).zip([normal, corners[0], corners[1], corners[2]]) {
        for (bytes, x) in bytes.chunks_exact_mut(4).zip(point.to_array()) {
            bytes.copy_from_slice(&x.to_le_bytes());
        }
    }
    facet[ATTRIBUTE..].copy_from_slice(&attribute);
    facet
}

/// The facets of a binary file that has been read. The attribute of a facet, a colour in some dialects, is its group.
pub(super) fn held_faces<'a>(bytes: &'a [u8], mesh: &'a Mesh) -> Faces<'a> {
    let (facets, _) = bytes.get(HEADER..).unwrap_or_default().as_chunks::<FACET>();
    let mut groups = Numbers::<Vec<&[u8]>>::default();
    let face = |(f, facet): (usize, &'a [u8; FACET])| {
        let start = HEADER + FACET * f;
        let group = groups.of([&facet[ATTRIBUTE..]].as_slice());
        Face { bytes: start..start + FACET, triangles: 1, group }
    };
    let list = facets.iter().enumerate().map(face).collect();
    let write = move |out: &mut Vec<u8>, attribute: &[&[u8]], triangle: [u32; 3], _: &[[u32; 3]]| {
        let corners = triangle.map(|v| mesh.point3(v).as_vec3());
        let attribute = attribute.first().and_then(|attribute| attribute.first_chunk());
        out.extend_from_slice(&bytes_of(corners, attribute.copied().unwrap_or_default()));
        Ok(())
    };
    Faces {
        lists: vec![list],
        names: vec!["attribute".to_owned()],
        groups: groups.into_known(),
        corners: Vec::new(),
        counts: Vec::new(),
        separator: b"",
        write: Box::new(write),
    }
}

/// The number of facets in the header of a binary file.
fn announced(header: &[u8]) -> Option<usize> {
    let count = header.get(80..HEADER)?.first_chunk()?;
    Some(u32::from_le_bytes(*count) as usize)
}

/// Whether a file of `length` bytes that begins with `header` is text. A binary file may also begin with `solid`; then
/// its length fits its number of facets, or it has a zero byte, as every number of facets below 2^24 does.
pub(super) fn is_text(header: &[u8], length: usize) -> bool {
    let binary = announced(header).and_then(|count| count.checked_mul(FACET)?.checked_add(HEADER));
    let word = Lines::new(header).find_map(|line| Tokens(line).next()).unwrap_or_default();
    binary != Some(length) && !header.contains(&0) && word.eq_ignore_ascii_case(b"solid")
}

fn binary(bytes: &[u8]) -> Result<Parsed, Error> {
    let at = |byte: usize, message: String| Error::Parse { place: format!("byte {byte}"), message };
    let Some(count) = announced(bytes) else {
        let message = format!("expected solid, or the {HEADER} bytes before the facets of a binary STL file");
        return Err(at(0, message));
    };
    let (facets, rest) = bytes[HEADER..].as_chunks::<FACET>();
    if facets.len() < count {
        let message = format!("the file ends after {} of {count} facets", facets.len());
        return Err(at(bytes.len(), message));
    }
    if facets.len() > count || !rest.trim_ascii().is_empty() {
        let end = HEADER + FACET * count;
        let message = format!(
            "expected the end of the file after {count} facets, found {} more bytes",
            bytes.len() - end
        );
        return Err(at(end, message));
    }
    refuse_too_many(count)?;
    let mut dropped = Dropped::default();
    let mut corners = Vec::with_capacity(3 * count);
    for (f, facet) in facets.iter().enumerate() {
        let (numbers, _) = facet[12..].as_chunks::<4>();
        for (n, axis) in (0..9).zip(['x', 'y', 'z'].into_iter().cycle()) {
            let x = f32::from_le_bytes(numbers[n]);
            if !x.is_finite() {
                let value = crate::error::number(x.into());
                let message = format!("coordinate {axis} is {value}, not a finite number");
                return Err(at(HEADER + FACET * f + 12 + 4 * n, message));
            }
        }
        corners
            .extend([0, 3, 6].map(|n| [numbers[n], numbers[n + 1], numbers[n + 2]].map(f32::from_le_bytes)));
        if facet[ATTRIBUTE..] != [0, 0] {
            dropped.note("attributes of facets");
        }
    }
    let faces = CutFaces::of((0..3 * count as u32).collect());
    Ok(merged(corners, faces, dropped))
}

/// Parses blocks `solid … endsolid` with facets in them.
fn text<T: Corner>(bytes: &[u8], asks: bool) -> Result<Parsed, Error>
where
    Positions: From<Vec<T>>,
{
    let mut reading = Reading { asks, loses: false };
    let mut words = Words { lines: Lines::new(bytes), line: Tokens(b"") };
    let (mut corners, mut faces) = (Vec::<[T; 3]>::new(), CutFaces::default());
    'file: while let Some(word) = words.next() {
        words.is(word, "solid")?;
        words.line = Tokens(b""); // skips the name
        loop {
            let word = words.after("facet or endsolid")?;
            if word.eq_ignore_ascii_case(b"endsolid") {
                words.line = Tokens(b"");
                break;
            }
            if !word.eq_ignore_ascii_case(b"facet") {
                return Err(words.expected("facet or endsolid", word));
            }
            facet(&mut words, &mut reading, &mut corners, &mut faces)?;
            if reading.loses {
                break 'file;
            }
        }
    }
    Ok(Parsed { loses: reading.loses, ..merged(corners, faces, Dropped::default()) })
}

/// Reads a facet after its first word. It may have more than three corners.
fn facet<T: Float>(
    words: &mut Words,
    reading: &mut Reading,
    corners: &mut Vec<[T; 3]>,
    faces: &mut CutFaces,
) -> Result<(), Error> {
    words.keyword("normal")?;
    for _ in 0..3 {
        let word = words.after("a number")?;
        float(word).ok_or_else(|| words.expected("a number", word))?;
    }
    words.keyword("outer")?;
    words.keyword("loop")?;
    let first = corners.len();
    loop {
        let is_face = corners.len() > first + 2;
        let word = words.after("vertex")?;
        if is_face && word.eq_ignore_ascii_case(b"endloop") {
            break;
        }
        words.is(word, "vertex")?;
        let mut point = [T::default(); 3];
        for x in &mut point {
            *x = reading
                .coordinate(words.after("a number")?)
                .map_err(|message| words.lines.refuse(message))?;
        }
        corners.push(point);
        refuse_too_many(corners.len() / 3)?;
    }
    faces.push(&(first as u32..corners.len() as u32).collect::<Vec<_>>());
    words.keyword("endfacet")
}

/// The words of a text, across lines.
struct Words<'a> {
    lines: Lines<'a>,
    line: Tokens<'a>,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.line.next() {
                return Some(word);
            }
            self.line = Tokens(self.lines.next()?);
        }
    }

    fn after(&mut self, expected: &str) -> Result<&'a [u8], Error> {
        self.next()
            .ok_or_else(|| self.lines.refuse(format!("expected {expected}, found the end of the file")))
    }

    fn keyword(&mut self, keyword: &str) -> Result<(), Error> {
        let word = self.after(keyword)?;
        self.is(word, keyword)
    }

    fn is(&self, word: &[u8], keyword: &str) -> Result<(), Error> {
        if word.eq_ignore_ascii_case(keyword.as_bytes()) { Ok(()) } else { Err(self.expected(keyword, word)) }
    }

    fn expected(&self, expected: &str, found: &[u8]) -> Error {
        self.lines.refuse(format!("expected {expected}, found {}", quoted(found)))
    }
}

/// Refuses more facets than 32-bit indices of corners allow.
fn refuse_too_many(count: usize) -> Result<(), Error> {
    if count > MAX_TRIANGLES {
        return Err(Error::TooLarge { what: "triangles", count, limit: MAX_TRIANGLES });
    }
    Ok(())
}

/// A coordinate of a corner.
trait Corner: Float {
    /// A position, with -0 as 0.
    type Place: Copy + Ord;

    fn place(corner: [Self; 3]) -> Self::Place;
}

impl Corner for f32 {
    type Place = (u64, u32);

    fn place(corner: [Self; 3]) -> (u64, u32) {
        let [x, y, z] = corner.map(|x| (x + 0.0).to_bits());
        (u64::from(x) << 32 | u64::from(y), z)
    }
}

impl Corner for f64 {
    type Place = (u128, u64);

    fn place(corner: [Self; 3]) -> (u128, u64) {
        let [x, y, z] = corner.map(|x| (x + 0.0).to_bits());
        (u128::from(x) << 64 | u128::from(y), z)
    }
}

/// The mesh of `faces` over `corners`. Corners at the same position become one vertex. It sorts the corners, because no
/// file can make sorting slow, as it can with hashing.
fn merged<T: Corner>(corners: Vec<[T; 3]>, mut faces: CutFaces, dropped: Dropped) -> Parsed
where
    Positions: From<Vec<T>>,
{
    let mut sorted: Vec<(T::Place, u32)> =
        corners.iter().zip(0..).map(|(&corner, i)| (T::place(corner), i)).collect();
    sorted.sort_unstable();
    // For each corner, first the first corner at its position, later its vertex.
    let mut vertices = vec![0; corners.len()];
    for group in sorted.chunk_by(|a, b| a.0 == b.0) {
        for &(_, corner) in group {
            vertices[corner as usize] = group[0].1;
        }
    }
    let mut positions = Vec::new();
    for i in 0..corners.len() {
        let first = vertices[i] as usize;
        vertices[i] = if first == i { (positions.len() / 3) as u32 } else { vertices[first] };
        if first == i {
            positions.extend(corners[i]);
        }
    }
    for v in &mut faces.triangles {
        *v = vertices[*v as usize];
    }
    Parsed { stride: Dimension::Three.stride(), positions: positions.into(), faces, dropped, loses: false }
}
