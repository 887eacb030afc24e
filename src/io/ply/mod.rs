//! PLY, the Stanford triangle format: a header that names elements and their properties, then their numbers, as text or
//! binary. The elements `vertex`, `face` and `tristrips` make the mesh.
//! Source: G. Turk, "The PLY Polygon File Format", 1994.

mod faces;
mod header;
mod source;

pub(super) use faces::{held_faces, is_held};

use super::coordinates;
use super::options::Coordinates;
use super::parsed::{CutFaces, Dropped, Parsed};
use super::text::{Lines, quoted};
use crate::error::number;
use crate::{Error, Mesh, Positions};
use header::{Element, Encoding, Header, Property, Role, Scalar, role};
use source::{Ascii, Source, binary};
use std::io::{self, Write};

/// The most names of properties that a note lists.
const LISTED: usize = 12;

/// Reads a file's bytes.
pub(super) fn parse(bytes: &[u8], option: Option<Coordinates>) -> Result<Parsed, Error> {
    let mut lines = Lines::new(bytes);
    let Header { encoding, elements } = Header::parse(&mut lines)?;
    if encoding != Encoding::Ascii {
        return Body::read(binary(bytes, &lines, encoding), &elements, false);
    }
    let text = |asks| Ascii::new(lines.clone(), asks);
    coordinates::read(
        option,
        |asks| Body::read(text(asks), &elements, false),
        || Body::read(text(false), &elements, true),
    )
}

/// Writes `mesh` in binary, least significant byte first, with 32-bit or 64-bit floats as in the mesh. z is 0 in a 2D
/// mesh.
pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let float = match mesh.positions() {
        Positions::F32(_) => "float",
        Positions::F64(_) => "double",
    };
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty {float} x\nproperty {float} y\n\
         property {float} z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertex_count(),
        mesh.triangle_count(),
    )?;
    let stride = mesh.dimension().stride();
    match mesh.positions() {
        Positions::F32(numbers) => write_numbers(numbers, stride, f32::to_le_bytes, out)?,
        Positions::F64(numbers) => write_numbers(numbers, stride, f64::to_le_bytes, out)?,
    }
    for triangle in mesh.triangles().chunks_exact(3) {
        let mut record = [3; 13];
        for (bytes, v) in record[1..].chunks_exact_mut(4).zip(triangle) {
            bytes.copy_from_slice(&v.to_le_bytes());
        }
        out.write_all(&record)?;
    }
    Ok(())
}

fn write_numbers<T: Copy + Default, const N: usize>(
    numbers: &[T],
    stride: usize,
    bytes: impl Fn(T) -> [u8; N],
    out: &mut impl Write,
) -> io::Result<()> {
    for vertex in numbers.chunks_exact(stride) {
        for axis in 0..3 {
            out.write_all(&bytes(vertex.get(axis).copied().unwrap_or_default()))?;
        }
    }
    Ok(())
}

/// The mesh read so far.
struct Body<S> {
    source: S,
    /// The number of vertices in the header.
    vertices: u64,
    stride: usize,
    positions: Positions,
    wide: bool,
    faces: CutFaces,
    corners: Vec<u32>,
}

impl<'a, S: Source<'a>> Body<S> {
    /// Stops after the first vertex that loses digits. `wide`: coordinates are read as 64-bit floats.
    fn read(source: S, elements: &[Element], wide: bool) -> Result<Parsed, Error> {
        let (vertices, stride, positions) = announced(elements, wide)?;
        let mut body = Self {
            source,
            vertices,
            stride,
            positions,
            wide,
            faces: CutFaces::default(),
            corners: Vec::new(),
        };
        let mut dropped = Dropped::default();
        let mut skipped = Vec::new();
        for element in elements.iter().filter(|element| element.count > 0) {
            let properties: Vec<_> =
                element.properties.iter().map(|property| (role(element.name, property), *property)).collect();
            match element.name {
                b"vertex" | b"face" | b"tristrips" => {
                    let names = properties.iter().filter(|(role, _)| *role == Role::Skipped);
                    let names: Vec<_> = names.map(|(_, property)| property.name).collect();
                    if !names.is_empty() {
                        let element = element.name.escape_ascii();
                        dropped.note(&format!("{element} properties {}", listed(&names)));
                    }
                }
                name => skipped.push(name),
            }
            body.element(element, &properties)?;
            if body.source.loses() {
                let Self { stride, positions, faces, .. } = body;
                return Ok(Parsed { stride, positions, faces, dropped, loses: true });
            }
        }
        if !skipped.is_empty() {
            dropped.note(&format!("elements {}", listed(&skipped)));
        }
        body.source.finish()?;
        let Self { stride, positions, faces, .. } = body;
        Ok(Parsed { stride, positions, faces, dropped, loses: false })
    }

    /// Reads all records of an element.
    fn element(&mut self, element: &Element, properties: &[(Role, Property)]) -> Result<(), Error> {
        // Records without properties take no bytes, so the file would not limit the loop.
        if properties.is_empty() {
            return Ok(());
        }
        self.reserve(element.count, properties);
        for record in 0..element.count {
            if !self.source.begin() {
                let (count, name) = (element.count, quoted(element.name));
                return Err(self
                    .source
                    .refuse(format!("the file ends after {record} of {count} elements {name}")));
            }
            let mut point = [0.0; 3];
            for &(role, Property { length, scalar, .. }) in properties {
                match (role, length) {
                    (Role::Coordinate(axis), _) => point[axis] = self.coordinate(axis, scalar)?,
                    (_, None) => self.source.skip(scalar, 1)?,
                    (role, Some(length)) => self.list(role, length, scalar)?,
                }
            }
            self.source.end()?;
            if element.name == b"vertex" {
                match &mut self.positions {
                    Positions::F32(numbers) => numbers.extend(point[..self.stride].iter().map(|&x| x as f32)),
                    Positions::F64(numbers) => numbers.extend(&point[..self.stride]),
                }
                if self.source.loses() {
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Reserves memory for `count` records, but not for more than fit the rest of the file.
    fn reserve(&mut self, count: u64, properties: &[(Role, Property)]) {
        let least = |(role, property): &(Role, Property)| match (role, property.length) {
            (Role::Polygon, Some(length)) => {
                self.source.least(length) + 3 * self.source.least(property.scalar)
            }
            (_, Some(length)) => self.source.least(length),
            (_, None) => self.source.least(property.scalar),
        };
        let most = (self.source.bytes_left() + 1) / properties.iter().map(least).sum::<usize>();
        let records = usize::try_from(count).unwrap_or(usize::MAX).min(most);
        if properties.iter().any(|(role, _)| *role == Role::Polygon) {
            self.faces.triangles.reserve_exact(3 * records);
        } else if properties.iter().any(|(role, _)| matches!(role, Role::Coordinate(_))) {
            match &mut self.positions {
                Positions::F32(numbers) => numbers.reserve_exact(self.stride * records),
                Positions::F64(numbers) => numbers.reserve_exact(self.stride * records),
            }
        }
    }

    fn coordinate(&mut self, axis: usize, scalar: Scalar) -> Result<f64, Error> {
        let x = self.source.number(if self.wide && scalar == Scalar::F32 { Scalar::F64 } else { scalar })?;
        if !x.is_finite() && !self.source.loses() {
            let (axis, value) = (['x', 'y', 'z'][axis], number(x));
            return Err(self.source.refuse(format!("coordinate {axis} is {value}, not a finite number")));
        }
        Ok(x)
    }

    fn list(&mut self, role: Role, length: Scalar, scalar: Scalar) -> Result<(), Error> {
        let length = self.source.number(length)? as i64;
        if role == Role::Polygon && length < 3 {
            return Err(self
                .source
                .refuse(format!("a face with {length} corners, but a face needs at least 3")));
        }
        let length = u64::try_from(length).map_err(|_| {
            self.source.refuse(format!("a list with {length} numbers, but it cannot have less than 0"))
        })?;
        if role == Role::Skipped {
            return self.source.skip(scalar, length);
        }
        self.corners.clear();
        for _ in 0..length {
            let index = self.source.number(scalar)?;
            if 0.0 <= index && index < self.vertices as f64 {
                self.corners.push(index as u32);
            } else if role == Role::Strip && index == -1.0 {
                self.strip();
            } else {
                let (index, vertices) = (index as i64, self.vertices);
                let message =
                    format!("vertex index {index} is out of range, the mesh has {vertices} vertices");
                return Err(self.source.refuse(message));
            }
        }
        match role {
            Role::Strip => self.strip(),
            _ => self.faces.push(&self.corners),
        }
        Ok(())
    }

    /// Adds the triangles of a strip, with every second one reversed. Skips triangles with a repeated corner.
    fn strip(&mut self) {
        for (i, corners) in self.corners.windows(3).enumerate() {
            let [mut a, mut b, c] = [corners[0], corners[1], corners[2]];
            if a == b || b == c || c == a {
                continue;
            }
            if i % 2 == 1 {
                (a, b) = (b, a);
            }
            self.faces.triangles.extend([a, b, c]);
        }
        self.corners.clear();
    }
}

/// The number of vertices, the coordinates per vertex, and empty positions of the right type. Refuses a header without
/// a mesh.
fn announced(elements: &[Element], wide: bool) -> Result<(u64, usize, Positions), Error> {
    let refuse = |message: String| Error::Parse { place: "header".into(), message };
    let named = |name: &'static [u8]| {
        let mut found = elements.iter().filter(move |element| element.name == name);
        match (found.next(), found.next()) {
            (_, Some(_)) => Err(refuse(format!("there are two elements {}", quoted(name)))),
            (first, None) => Ok(first),
        }
    };
    for name in [b"face".as_slice(), b"tristrips"] {
        let Some(element) = named(name)? else { continue };
        let lists = element.properties.iter().filter(|p| role(name, p) != Role::Skipped).count();
        if lists != 1 {
            let name = quoted(name);
            return Err(refuse(format!(
                "element {name} needs one list vertex_indices of integers, but has {lists}"
            )));
        }
    }
    let Some(vertex) = named(b"vertex")? else { return Err(refuse("there is no element `vertex`".into())) };
    let mut types = [None; 3];
    for property in &vertex.properties {
        if let Role::Coordinate(axis) = role(vertex.name, property)
            && types[axis].replace(property.scalar).is_some()
        {
            return Err(refuse(format!("element `vertex` has two properties {}", quoted(property.name))));
        }
    }
    let [Some(_), Some(_), z] = types else {
        return Err(refuse("element `vertex` needs the properties x and y".into()));
    };
    let is_narrow = !wide && types.iter().flatten().all(|scalar| scalar.fits_f32());
    let positions = if is_narrow { Positions::F32(Vec::new()) } else { Positions::F64(Vec::new()) };
    Ok((vertex.count, if z.is_some() { 3 } else { 2 }, positions))
}

/// The first names, for a note.
fn listed(names: &[&[u8]]) -> String {
    let mut text: Vec<_> = names.iter().take(LISTED).map(|name| quoted(name)).collect();
    if names.len() > LISTED {
        text.push(format!("and {} more", names.len() - LISTED));
    }
    text.join(", ")
}
