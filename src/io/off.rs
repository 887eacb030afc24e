//! OFF, Geomview's object file format: `[ST][C][N][n]OFF`, counts, one line per vertex, one line per face.
//! A line that ends too early continues in the next one. Source: the Geomview manual, "OFF Files". Text only.

use super::coordinates::{self, Float, Reading};
use super::held::{Face, Faces, Numbers, line_end, range_in};
use super::options::Coordinates;
use super::parsed::{CutFaces, Dropped, Parsed};
use super::pieces::{self, Piece};
use super::text::{Digits, Lines, Tokens, float, integer, quoted, without_comment};
use crate::{Error, Mesh, Positions};
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

const ATTRIBUTES: &str = "numbers after a vertex's coordinates (normals, colours, texture coordinates)";
const COLOURS: &str = "face colours";

/// Reads a file's bytes.
pub(super) fn parse(bytes: &[u8], option: Option<Coordinates>) -> Result<Parsed, Error> {
    coordinates::read(option, |asks| read::<f32>(bytes, asks), || read::<f64>(bytes, false))
}

fn read<T: Float>(bytes: &[u8], asks: bool) -> Result<Parsed, Error>
where
    Positions: From<Vec<T>>,
{
    let mut lines = Lines::new(bytes);
    let header = Header::parse(&mut lines)?;
    let threads = pieces::threads(lines.bytes_left());
    let pieces = pieces::cut(&lines, is_content, &threads);
    // Only saves work: a piece that ends for it is not used.
    let ends = AtomicBool::new(false);
    let mut parts = threads.map_each(pieces, |piece| Part::<T>::read(piece, &header, asks, false, &ends));
    if parts.iter().flatten().any(|part| part.is_short) {
        ends.store(false, Relaxed);
        parts = vec![Part::read(Piece::whole(&lines), &header, asks, true, &ends)];
    }
    let (mut positions, mut faces, mut dropped) = (Vec::new(), Vec::new(), Dropped::default());
    let Header { stride, vertices, faces: announced, .. } = header;
    // Before all errors, so that the result does not depend on the number of threads.
    if parts.iter().flatten().any(|part| part.reading.loses) {
        let positions = Vec::<T>::new().into();
        return Ok(Parsed { stride, positions, faces: CutFaces::default(), dropped, loses: true });
    }
    let (mut found, mut end) = (0, lines);
    for part in parts {
        let part = part?;
        positions.push(part.positions);
        faces.push(part.faces);
        part.dropped.0.iter().for_each(|what| dropped.note(what));
        (found, end) = (part.found, part.end);
    }
    let message = match found.checked_sub(vertices) {
        None => format!("the file ends after {found} of {vertices} vertices"),
        Some(found) if found < announced => format!("the file ends after {found} of {announced} faces"),
        Some(_) => {
            let positions = pieces::joined(positions, &threads).into();
            let faces = CutFaces::joined(faces, &threads);
            return Ok(Parsed { stride, positions, faces, dropped, loses: false });
        }
    };
    Err(end.refuse(message))
}

/// The faces of a file that has been read. The text after the vertices of a face is its colour.
pub(super) fn held_faces(bytes: &[u8]) -> Result<Faces<'_>, Error> {
    let mut lines = Lines::new(bytes);
    let header = Header::parse(&mut lines)?;
    let counts = header.growing.iter().map(|count| range_in(bytes, count)).collect();
    let threads = pieces::threads(lines.bytes_left());
    let pieces = pieces::cut(&lines, is_content, &threads);
    let read = |piece, continues| {
        let Piece { mut lines, items } = piece;
        let (mut list, mut colours, mut item) = (Vec::new(), Numbers::<Vec<&[u8]>>::default(), items.start);
        while let Some(mut tokens) = content(&mut lines) {
            let start = range_in(bytes, tokens.0.trim_ascii_start()).start;
            let is_face = item >= header.vertices;
            let corners = if is_face { tokens.next().and_then(integer).unwrap_or_default() } else { 0 };
            let numbers = if is_face { corners.unsigned_abs() } else { header.stride as u64 };
            for _ in 0..numbers {
                token(&mut tokens, &mut lines, continues)?;
            }
            item += 1;
            if is_face {
                let end = range_in(bytes, tokens.0.trim_ascii_end()).end;
                let group = colours.of([tokens.0.trim_ascii()].as_slice());
                list.push(Face { bytes: start..end, triangles: (numbers as usize).saturating_sub(2), group });
            }
        }
        Some((list, colours.into_known()))
    };
    let parts: Option<Vec<_>> = threads.map_each(pieces, |piece| read(piece, false)).into_iter().collect();
    let parts = parts.unwrap_or_else(|| read(Piece::whole(&lines), true).into_iter().collect());
    let (mut lists, mut colours) = (Vec::new(), Numbers::<Vec<&[u8]>>::default());
    for (mut list, known) in parts {
        // Replaces the group numbers of the piece by those of the file.
        let groups: Vec<u32> = known.iter().map(|colour| colours.of(colour.as_slice())).collect();
        if groups.iter().zip(0..).any(|(&group, own)| group != own) {
            list.iter_mut().for_each(|face| face.group = groups[face.group as usize]);
        }
        lists.push(list);
    }
    let write = |out: &mut Vec<u8>, colour: &[&[u8]], triangle: [u32; 3], _: &[[u32; 3]]| {
        let mut digits = Digits::default();
        out.push(b'3');
        for vertex in triangle {
            out.push(b' ');
            digits.integer(out, vertex.into());
        }
        for colour in colour.iter().filter(|colour| !colour.is_empty()) {
            out.push(b' ');
            out.extend_from_slice(colour);
        }
        Ok(())
    };
    Ok(Faces {
        lists,
        names: vec!["colour".to_owned()],
        groups: colours.into_known(),
        corners: Vec::new(),
        counts,
        separator: line_end(bytes),
        write: Box::new(write),
    })
}

/// Writes `mesh`; z is 0 in a 2D mesh.
pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "OFF\n{} {} 0", mesh.vertex_count(), mesh.triangle_count())?;
    let stride = mesh.dimension().stride();
    pieces::write(mesh.vertex_count(), out, |vertex, digits, text| {
        for i in stride * vertex..stride * (vertex + 1) {
            digits.coordinate(text, mesh.positions(), i);
            text.push(b' ');
        }
        if stride == 2 {
            text.extend_from_slice(b"0 ");
        }
        text.pop();
        text.push(b'\n');
    })?;
    let triangles = mesh.triangles().as_chunks::<3>().0;
    pieces::write(triangles.len(), out, |triangle, digits, text| {
        text.push(b'3');
        for v in triangles[triangle] {
            text.push(b' ');
            digits.integer(text, u64::from(v));
        }
        text.push(b'\n');
    })
}

/// The next line that has more than white space and a comment.
fn content<'a>(lines: &mut Lines<'a>) -> Option<Tokens<'a>> {
    lines.find(|line| is_content(line)).map(without_comment).map(Tokens)
}

fn is_content(line: &[u8]) -> bool {
    without_comment(line).iter().any(|b| !b.is_ascii_whitespace())
}

/// The next word of the line or, if the item continues there, of the lines after it.
fn token<'a>(tokens: &mut Tokens<'a>, lines: &mut Lines<'a>, continues: bool) -> Option<&'a [u8]> {
    loop {
        if let Some(token) = tokens.next() {
            return Some(token);
        }
        *tokens = continues.then(|| content(lines)).flatten()?;
    }
}

/// The keyword and the counts.
struct Header<'a> {
    stride: usize,
    vertices: u64,
    faces: u64,
    /// The text of the counts that grow when faces are cut: the number of faces, and that of edges unless it is 0.
    growing: Vec<&'a [u8]>,
}

impl<'a> Header<'a> {
    fn parse(lines: &mut Lines<'a>) -> Result<Self, Error> {
        let mut tokens =
            content(lines).ok_or_else(|| lines.refuse("the file ends before the keyword OFF"))?;
        let word = tokens.next().unwrap_or_default();
        let Some((keyword, glued)) = Keyword::split(word) else {
            let message = format!("expected the keyword OFF of an OFF file, found {}", quoted(word));
            return Err(lines.refuse(message));
        };
        if keyword.homogeneous {
            return Err(lines.refuse("vertices with four coordinates (4OFF) are not supported"));
        }
        let mut numbers: Vec<&[u8]> = Vec::new();
        numbers.extend((!glued.is_empty()).then_some(glued));
        numbers.extend(tokens);
        if numbers.first() == Some(&b"BINARY".as_slice()) {
            return Err(lines.refuse("binary OFF is not supported, only text"));
        }
        let mut stride = keyword.stride;
        if keyword.dimension_follows {
            if numbers.is_empty() {
                numbers = Self::next_numbers(lines, "the number of dimensions")?;
            }
            stride = match integer(numbers.remove(0)) {
                Some(2) => 2,
                Some(3) => 3,
                _ => return Err(lines.refuse("an nOFF file must have 2 or 3 dimensions")),
            };
        }
        if numbers.is_empty() {
            numbers = Self::next_numbers(lines, "the numbers of vertices and faces")?;
        }
        if !(2..=3).contains(&numbers.len()) {
            let message =
                format!("expected the numbers of vertices, faces and edges, found {} words", numbers.len());
            return Err(lines.refuse(message));
        }
        let mut counts = [0; 3];
        for (count, token) in counts.iter_mut().zip(&numbers) {
            *count = integer(token).and_then(|n| u64::try_from(n).ok()).ok_or_else(|| {
                lines
                    .refuse(format!("expected a number of vertices, faces or edges, found {}", quoted(token)))
            })?;
        }
        numbers.truncate(if counts[2] == 0 { 2 } else { 3 });
        Ok(Self { stride, vertices: counts[0], faces: counts[1], growing: numbers.split_off(1) })
    }

    fn next_numbers(lines: &mut Lines<'a>, what: &str) -> Result<Vec<&'a [u8]>, Error> {
        match content(lines) {
            Some(tokens) => Ok(tokens.collect()),
            None => Err(lines.refuse(format!("the file ends before {what}"))),
        }
    }
}

/// The first word of the file.
struct Keyword {
    stride: usize,
    homogeneous: bool,
    dimension_follows: bool,
}

impl Keyword {
    /// The keyword and the text glued to it: some well-known data sets write `OFF490 518 0`.
    fn split(word: &[u8]) -> Option<(Self, &[u8])> {
        let mut keyword = Self { stride: 3, homogeneous: false, dimension_follows: false };
        let mut rest = word;
        loop {
            rest = match rest {
                [b'O', b'F', b'F', glued @ ..] | [b'o', b'f', b'f', glued @ ..] => {
                    return Some((keyword, glued));
                }
                [b'S', b'T', rest @ ..] | [b'C' | b'N' | b'3', rest @ ..] => rest,
                [b'2', rest @ ..] => {
                    keyword.stride = 2;
                    rest
                }
                [b'4', rest @ ..] => {
                    keyword.homogeneous = true;
                    rest
                }
                [b'n', rest @ ..] => {
                    keyword.dimension_follows = true;
                    rest
                }
                _ => return None,
            }
        }
    }
}

/// The smaller of `count` and the number of elements that fit the rest of the file. An element has `numbers` numbers,
/// each of at least a digit and a separator.
fn capacity(lines: &Lines, count: u64, numbers: usize) -> usize {
    let limit = (lines.bytes_left() + 1) / (2 * numbers);
    usize::try_from(count).unwrap_or(usize::MAX).min(limit)
}

/// The content of a piece of the file.
struct Part<'a, T> {
    positions: Vec<T>,
    reading: Reading,
    faces: CutFaces,
    dropped: Dropped,
    /// Whether an item continues in the next line if its line ends too early.
    continues: bool,
    /// Whether a line ends too early, and no item continues.
    is_short: bool,
    /// The number of vertices and faces up to its end.
    found: u64,
    end: Lines<'a>,
}

impl<'a, T: Float> Part<'a, T> {
    /// Stops after the first vertex that loses digits, and after the first line that ends too early, and where another
    /// piece has stopped: `ends`.
    fn read(
        Piece { lines, items }: Piece<'a>,
        header: &Header,
        asks: bool,
        continues: bool,
        ends: &AtomicBool,
    ) -> Result<Self, Error> {
        let &Header { stride, vertices, faces, .. } = header;
        let count = |first: u64, end: u64| end.min(items.end).saturating_sub(first.max(items.start));
        let positions = stride * capacity(&lines, count(0, vertices), stride);
        let triangles = 3 * capacity(&lines, count(vertices, vertices + faces), 4);
        let fans = CutFaces::of(Vec::with_capacity(triangles));
        let dropped = Dropped::default();
        let mut part = Self {
            positions: Vec::with_capacity(positions),
            reading: Reading { asks, loses: false },
            faces: fans,
            dropped,
            continues,
            is_short: false,
            found: items.start,
            end: lines,
        };
        let mut corners = Vec::new();
        while let Some(tokens) = content(&mut part.end) {
            match part.found.checked_sub(vertices) {
                None => part.vertex(tokens, stride)?,
                Some(face) if face < faces => part.face(tokens, vertices, &mut corners)?,
                Some(_) => {
                    let found = quoted(tokens.0.trim_ascii());
                    let message = format!("expected the end of the file after {faces} faces, found {found}");
                    return Err(part.end.refuse(message));
                }
            }
            part.found += 1;
            if part.reading.loses || part.is_short {
                ends.store(true, Relaxed);
            }
            if ends.load(Relaxed) {
                break;
            }
        }
        Ok(part)
    }

    /// The next word of an item. `None` if the line or, if items continue, the file ends.
    fn token(&mut self, tokens: &mut Tokens<'a>) -> Option<&'a [u8]> {
        let token = token(tokens, &mut self.end, self.continues);
        self.is_short |= token.is_none() && !self.continues;
        token
    }

    fn vertex(&mut self, mut tokens: Tokens<'a>, stride: usize) -> Result<(), Error> {
        for found in 0..stride {
            let Some(token) = self.token(&mut tokens) else {
                return self.ended(format!("expected {stride} coordinates, found {found}"));
            };
            let x = self.reading.coordinate(token).map_err(|message| self.end.refuse(message))?;
            self.positions.push(x);
        }
        drop_numbers(&self.end, tokens, ATTRIBUTES, &mut self.dropped)
    }

    fn face(&mut self, mut tokens: Tokens<'a>, vertices: u64, corners: &mut Vec<u32>) -> Result<(), Error> {
        let first = tokens.next().unwrap_or_default();
        let Some(size) = integer(first) else {
            let message = format!("expected a face's number of corners, found {}", quoted(first));
            return Err(self.end.refuse(message));
        };
        if size < 3 {
            let message = format!("a face with {size} corners, but a face needs at least 3");
            return Err(self.end.refuse(message));
        }
        corners.clear();
        for found in 0..size {
            let Some(token) = self.token(&mut tokens) else {
                return self.ended(format!("expected {size} vertex indices, found {found}"));
            };
            corners.push(index(token, vertices).map_err(|message| self.end.refuse(message))?);
        }
        self.faces.push(corners);
        drop_numbers(&self.end, tokens, COLOURS, &mut self.dropped)
    }

    /// The file, or only the line, ends within an item.
    fn ended(&self, message: String) -> Result<(), Error> {
        if self.is_short { Ok(()) } else { Err(self.end.refuse(message)) }
    }
}

/// A vertex index below `vertices`, or what is wrong with it.
fn index(token: &[u8], vertices: u64) -> Result<u32, String> {
    let Some(i) = integer(token) else {
        return Err(format!("expected a vertex index, found {}", quoted(token)));
    };
    match u32::try_from(i) {
        Ok(v) if u64::from(v) < vertices => Ok(v),
        _ => {
            let token = quoted(token);
            Err(format!("vertex index {token} is out of range, the mesh has {vertices} vertices"))
        }
    }
}

/// Checks that the rest of a line is numbers, and notes that they are dropped.
fn drop_numbers(
    lines: &Lines,
    tokens: Tokens,
    what: &'static str,
    dropped: &mut Dropped,
) -> Result<(), Error> {
    for token in tokens {
        if float(token).is_none() {
            return Err(lines.refuse(format!("expected a number, found {}", quoted(token))));
        }
        dropped.note(what);
    }
    Ok(())
}
