//! The byte ranges of the faces of a PLY file, and the attributes of faces and corners.

use super::header::{Element, Encoding, Header, Property, Role, Scalar, role};
use super::source::{Ascii, Source, binary};
use crate::io::held::{Corners, Face, Faces, Numbers, line_end, of_corners, range_in};
use crate::io::parsed::Others;
use crate::io::text::{Digits, Lines, Tokens, quoted};
use crate::{Error, Mesh};

/// The property with two numbers for each corner of a face.
const TEXTURE: &str = "texcoord";

/// Whether a file that has been read can be written again with other triangles: it has no triangle strips.
pub(in crate::io) fn is_held(bytes: &[u8]) -> bool {
    let has_strips = |element: &Element| element.name == b"tristrips" && element.count > 0;
    Header::parse(&mut Lines::new(bytes)).is_ok_and(|header| !header.elements.iter().any(has_strips))
}

/// The faces of a file that has been read.
pub(in crate::io) fn held_faces<'a>(
    bytes: &'a [u8],
    mesh: &Mesh,
    others: &Others,
    ignored: &[String],
) -> Result<Faces<'a>, Error> {
    let mut lines = Lines::new(bytes);
    let Header { encoding, elements } = Header::parse(&mut lines)?;
    let cut = Corners::new(others);
    match encoding {
        Encoding::Ascii => of(bytes, Ascii::new(lines, false), &elements, encoding, mesh, cut, ignored),
        _ => of(bytes, binary(bytes, &lines, encoding), &elements, encoding, mesh, cut, ignored),
    }
}

/// How a face is written.
struct Form<'a> {
    encoding: Encoding,
    properties: Vec<Property<'a>>,
    /// The index of the list of vertices in `properties`.
    vertices: usize,
    /// The index of [`TEXTURE`] in `properties`.
    texture: Option<usize>,
}

fn of<'a>(
    bytes: &'a [u8],
    mut source: impl Source<'a>,
    elements: &[Element<'a>],
    encoding: Encoding,
    mesh: &Mesh,
    mut cut: Corners,
    ignored: &[String],
) -> Result<Faces<'a>, Error> {
    let (mut list, mut corners, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    let mut form = Form { encoding, properties: Vec::new(), vertices: 0, texture: None };
    let mut groups: Numbers<Vec<&[u8]>> = Numbers::default();
    for element in elements.iter().filter(|element| !element.properties.is_empty()) {
        if element.name != b"face" {
            (0..element.count).try_for_each(|_| source.pass(&element.properties))?;
            continue;
        }
        counts.push(range_in(bytes, element.digits));
        let at = |test: &dyn Fn(&Property) -> bool| element.properties.iter().position(test);
        form.properties.clone_from(&element.properties);
        form.vertices = at(&|property| role(b"face", property) == Role::Polygon).unwrap_or_default();
        form.texture = at(&|property| property.name == TEXTURE.as_bytes() && property.length.is_some());
        let (mut values, mut pieces) = (Vec::new(), Vec::new());
        for _ in 0..element.count {
            source.begin();
            let start = source.rest();
            let triangles = form.read(&mut source, &mut values, &mut pieces)?;
            let record = form.trimmed(&start[..start.len() - source.rest().len()]);
            let group = groups.of(values.as_slice());
            list.push(Face { bytes: range_in(bytes, record), triangles, group });
            if form.texture.is_none() {
                continue;
            }
            let piece = |corner: usize| pieces.get(corner).copied().unwrap_or_default();
            corners.extend(cut.of_next(triangles).map(piece));
        }
    }
    let name = |(_, property): (usize, &Property)| String::from_utf8_lossy(property.name).into_owned();
    let others = form.properties.iter().enumerate().filter(|&(i, _)| i != form.vertices);
    let names = others.map(name).collect();
    let texture = of_corners(mesh, TEXTURE, &corners, ignored, |piece: &[u8]| piece);
    let (corners, coordinates) = texture.unzip();
    let separator = if encoding == Encoding::Ascii { line_end(bytes) } else { b"" };
    let write = move |out: &mut Vec<u8>, values: &[&[u8]], triangle: [u32; 3], corners: &[[u32; 3]]| {
        let coordinates = coordinates.as_deref().unwrap_or_default();
        let corners = corners.first().copied().unwrap_or_default();
        let corners = corners.map(|corner| coordinates.get(corner as usize).copied().unwrap_or_default());
        form.write(out, values, triangle, corners)
    };
    Ok(Faces {
        lists: vec![list],
        names,
        groups: groups.into_known(),
        corners: corners.into_iter().collect(),
        counts,
        separator,
        write: Box::new(write),
    })
}

impl<'a> Form<'a> {
    /// Reads a face, and returns its number of triangles. Fills `values` with all properties except the vertices, and
    /// `pieces` with the texture coordinates of each corner; then their list in `values` is empty.
    fn read(
        &self,
        source: &mut impl Source<'a>,
        values: &mut Vec<&'a [u8]>,
        pieces: &mut Vec<&'a [u8]>,
    ) -> Result<usize, Error> {
        values.clear();
        pieces.clear();
        let (mut corners, mut texture) = (0, None);
        for (i, &Property { length, scalar, .. }) in self.properties.iter().enumerate() {
            let start = source.rest();
            let count = length.map_or(Ok(1.0), |length| source.number(length))? as u64;
            source.skip(scalar, count)?;
            if i == self.vertices {
                corners = count;
                continue;
            }
            if Some(i) == self.texture {
                texture = Some((values.len(), count));
            }
            values.push(self.trimmed(&start[..start.len() - source.rest().len()]));
        }
        if let (Some((index, count)), Some(texture)) = (texture, self.texture)
            && count == 2 * corners
        {
            self.divide(std::mem::take(&mut values[index]), &self.properties[texture], pieces);
        }
        Ok((corners as usize).saturating_sub(2))
    }

    /// Divides a list into the two numbers of each corner.
    fn divide(&self, list: &'a [u8], property: &Property, pieces: &mut Vec<&'a [u8]>) {
        if self.encoding == Encoding::Ascii {
            let mut words = Tokens(list).skip(1);
            while let (Some(u), Some(v)) = (words.next(), words.next()) {
                pieces.push(&list[range_in(list, u).start..range_in(list, v).end]);
            }
        } else {
            let length = property.length.map_or(0, Scalar::size);
            pieces.extend(list[length..].chunks_exact(2 * property.scalar.size()));
        }
    }

    /// Text without the white space around it; binary bytes unchanged.
    fn trimmed(&self, bytes: &'a [u8]) -> &'a [u8] {
        if self.encoding == Encoding::Ascii { bytes.trim_ascii() } else { bytes }
    }

    /// Writes a triangle with these values. If the texture coordinates are empty there, it takes those of the corners.
    fn write(
        &self,
        out: &mut Vec<u8>,
        values: &[&[u8]],
        triangle: [u32; 3],
        corners: [&[u8]; 3],
    ) -> Result<(), Error> {
        let start = out.len();
        let mut values = values.iter();
        for (i, property) in self.properties.iter().enumerate() {
            let length = property.length.unwrap_or(property.scalar);
            let value = if i == self.vertices { None } else { values.next() };
            if i == self.vertices {
                if let Some(vertex) = triangle.iter().find(|&&vertex| vertex > property.scalar.most()) {
                    let message =
                        format!("vertex index {vertex} does not fit the type of {}", quoted(property.name));
                    return Err(Error::Parse { place: "element `face`".into(), message });
                }
                self.put(out, start, length, 3);
                triangle.iter().for_each(|&vertex| self.put(out, start, property.scalar, vertex));
            } else if Some(i) == self.texture && value.is_some_and(|value| value.is_empty()) {
                if let Some(i) = corners.iter().position(|corner| corner.is_empty()) {
                    let (vertex, name) = (triangle[i], quoted(property.name));
                    let message =
                        format!("no triangle with these attributes has a {name} at vertex {vertex}");
                    return Err(Error::Option { option: "triangles", message });
                }
                self.put(out, start, length, 6);
                corners.iter().for_each(|corner| self.put_bytes(out, start, corner));
            } else if let Some(value) = value {
                self.put_bytes(out, start, value);
            }
        }
        Ok(())
    }

    /// Writes a number of the record that begins at `start`.
    fn put(&self, out: &mut Vec<u8>, start: usize, scalar: Scalar, number: u32) {
        let mut bytes = number.to_le_bytes();
        let size = scalar.size().min(bytes.len());
        match self.encoding {
            Encoding::Ascii => {
                self.put_bytes(out, start, b"");
                Digits::default().integer(out, number.into());
                return;
            }
            Encoding::LittleEndian => {}
            Encoding::BigEndian => bytes[..size].reverse(),
        }
        out.extend_from_slice(&bytes[..size]);
    }

    fn put_bytes(&self, out: &mut Vec<u8>, start: usize, bytes: &[u8]) {
        if self.encoding == Encoding::Ascii && out.len() > start {
            out.push(b' ');
        }
        out.extend_from_slice(bytes);
    }
}
