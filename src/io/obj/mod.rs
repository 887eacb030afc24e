//! OBJ, Wavefront's object format: every `v` and `f` of the file as one mesh, in the file's vertex order.
//! Groups, objects and materials do not divide the mesh. Source: Wavefront's Advanced Visualizer manual, appendix B1.

mod faces;
mod lines;

pub(super) use faces::held_faces;

use super::coordinates::{self, Float, Reading};
use super::options::Coordinates;
use super::parsed::{CutFaces, Dropped, Parsed};
use super::pieces;
use super::text::{Lines, Tokens, float, integer, quoted, without_comment};
use crate::{Error, Mesh, Positions};
use lines::continued;
use std::io::{self, Write};

/// Reads a file's bytes.
pub(super) fn parse(bytes: &[u8], option: Option<Coordinates>) -> Result<Parsed, Error> {
    coordinates::read(option, |asks| read::<f32>(bytes, asks), || read::<f64>(bytes, false))
}

fn read<T: Float>(bytes: &[u8], asks: bool) -> Result<Parsed, Error>
where
    Positions: From<Vec<T>>,
{
    let mut reader = Reader::<T>::new(asks);
    reader.read(Lines::new(bytes), None)?;
    let vertices = reader.vertices();
    // A face may name a later vertex, so only the end of the file shows whether an index is out of range. A second
    // pass, which knows the number of vertices, finds the line.
    if reader.largest >= vertices && !reader.reading.loses {
        reader = Reader::new(asks);
        reader.read(Lines::new(bytes), Some(vertices))?;
    }
    let Reader { positions, reading: Reading { loses, .. }, faces, dropped, .. } = reader;
    Ok(Parsed { stride: 3, positions: positions.into(), faces, dropped, loses })
}

/// The names of the files with materials.
pub(super) fn libraries(bytes: &[u8]) -> Vec<String> {
    let names = Lines::new(bytes).filter_map(|line| line.trim_ascii().strip_prefix(b"mtllib"));
    // A name may have spaces.
    names.map(|name| String::from_utf8_lossy(name.trim_ascii()).into_owned()).collect()
}

/// Writes `mesh`; z is 0 in a 2D mesh.
pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let stride = mesh.dimension().stride();
    pieces::write(mesh.vertex_count(), out, |vertex, digits, text| {
        text.push(b'v');
        for i in stride * vertex..stride * (vertex + 1) {
            text.push(b' ');
            digits.coordinate(text, mesh.positions(), i);
        }
        text.extend_from_slice(if stride == 2 { b" 0\n" } else { b"\n" });
    })?;
    let triangles = mesh.triangles().as_chunks::<3>().0;
    pieces::write(triangles.len(), out, |triangle, digits, text| {
        text.push(b'f');
        for v in triangles[triangle] {
            text.push(b' ');
            digits.integer(text, u64::from(v) + 1);
        }
        text.push(b'\n');
    })
}

/// The mesh read so far.
struct Reader<T> {
    positions: Vec<T>,
    reading: Reading,
    faces: CutFaces,
    dropped: Dropped,
    /// The largest vertex index so far, from 0; -1 before the first.
    largest: i64,
    corners: Vec<u32>,
}

impl<T: Float> Reader<T> {
    fn new(asks: bool) -> Self {
        Self {
            positions: Vec::new(),
            reading: Reading { asks, loses: false },
            faces: CutFaces::default(),
            dropped: Dropped::default(),
            largest: -1,
            corners: Vec::new(),
        }
    }

    /// The number of vertices so far. It fits, since a slice is never longer than `isize::MAX` bytes.
    fn vertices(&self) -> i64 {
        (self.positions.len() / 3) as i64
    }

    /// Reads all lines, or those up to the first coordinate that loses digits. `known` is the number of vertices of the
    /// whole file, if it is known.
    fn read(&mut self, mut lines: Lines, known: Option<i64>) -> Result<(), Error> {
        while let Some(line) = lines.next() {
            let number = lines.number();
            let (line, _) = continued(without_comment(line), &mut lines);
            self.line(&line, known)
                .map_err(|message| Error::Parse { place: format!("line {number}"), message })?;
            if self.reading.loses {
                return Ok(());
            }
        }
        if self.positions.is_empty() {
            return Err(lines.refuse("the file ends without a vertex (v) line"));
        }
        Ok(())
    }

    fn line(&mut self, line: &[u8], known: Option<i64>) -> Result<(), String> {
        let mut tokens = Tokens(line);
        let Some(keyword) = tokens.next() else { return Ok(()) };
        let dropped = match keyword {
            b"v" => return self.vertex(tokens),
            b"f" | b"fo" => return self.face(tokens, known),
            b"vt" => "texture coordinates",
            b"vn" => "normals",
            b"g" | b"o" | b"s" | b"mg" | b"mtllib" | b"usemtl" | b"maplib" | b"usemap" => {
                "groups, objects and materials"
            }
            b"p" | b"l" => "points and lines",
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm"
            | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech" | b"stech" => {
                "free-form curves and surfaces"
            }
            b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"shadow_obj" | b"trace_obj" => {
                "display attributes"
            }
            _ => return Err(format!("expected a keyword of an OBJ file, found {}", quoted(keyword))),
        };
        self.dropped.note(dropped);
        Ok(())
    }

    /// Reads `x y z`, and drops a weight or a colour.
    fn vertex(&mut self, mut tokens: Tokens) -> Result<(), String> {
        for found in 0..3 {
            let token = tokens.next().ok_or_else(|| format!("expected 3 coordinates, found {found}"))?;
            self.positions.push(self.reading.coordinate(token)?);
        }
        for token in tokens {
            if float(token).is_none() {
                return Err(format!("expected a number, found {}", quoted(token)));
            }
            self.dropped.note("vertex weights and colours");
        }
        Ok(())
    }

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn` for each corner.
    fn face(&mut self, tokens: Tokens, known: Option<i64>) -> Result<(), String> {
        self.corners.clear();
        for token in tokens {
            let corner = self.corner(token, known)?;
            self.largest = self.largest.max(corner);
            // An index that does not fit 32 bits is out of range: `parse` refuses it.
            self.corners.push(u32::try_from(corner).unwrap_or(u32::MAX));
        }
        if self.corners.len() < 3 {
            let found = self.corners.len();
            return Err(format!("a face with {found} corners, but a face needs at least 3"));
        }
        self.faces.push(&self.corners);
        Ok(())
    }

    /// The vertex index of a corner, from 0. In the file, positive indices count from 1, and negative ones count back
    /// from the last vertex so far.
    fn corner(&self, token: &[u8], known: Option<i64>) -> Result<i64, String> {
        let split = || {
            let mut parts = token.splitn(3, |&b| b == b'/');
            let vertex = parts.next().and_then(integer);
            vertex.filter(|_| parts.all(|part| part.is_empty() || integer(part).is_some()))
        };
        // Most files have no references.
        let Some(i) = integer(token).or_else(split) else {
            return Err(format!("expected a corner such as 1, 1/2, 1//3 or 1/2/3, found {}", quoted(token)));
        };
        let so_far = self.vertices();
        match i {
            0 => Err("vertex index 0 is out of range, OBJ counts from 1".into()),
            i if i < -so_far => {
                let token = quoted(token);
                Err(format!("vertex index {token} is out of range, there are {so_far} vertices so far"))
            }
            i if i < 0 => Ok(so_far + i),
            i => match known {
                Some(n) if i > n => {
                    Err(format!("vertex index {} is out of range, the mesh has {n} vertices", quoted(token)))
                }
                _ => Ok(i - 1),
            },
        }
    }
}
