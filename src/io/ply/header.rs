//! The header of a PLY file: the encoding of its numbers, and its elements with their properties.

use crate::Error;
use crate::io::text::{Lines, Tokens, integer, quoted};

/// The first words of lines that are not comments.
const KEYWORDS: [&[u8]; 4] = [b"format", b"element", b"property", b"end_header"];

/// A header.
pub(super) struct Header<'a> {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element<'a>>,
}

/// The encoding of the numbers after the header.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    /// Text, one line per record.
    Ascii,
    /// Binary without gaps, least significant byte first.
    LittleEndian,
    /// Binary without gaps, most significant byte first.
    BigEndian,
}

/// An element: `count` records with the same properties.
pub(super) struct Element<'a> {
    pub(super) name: &'a [u8],
    pub(super) count: u64,
    /// The text of the count.
    pub(super) digits: &'a [u8],
    pub(super) properties: Vec<Property<'a>>,
}

/// A number of each record, or a list of numbers.
#[derive(Clone, Copy)]
pub(super) struct Property<'a> {
    pub(super) name: &'a [u8],
    /// For a list, the type of its length, which comes first.
    pub(super) length: Option<Scalar>,
    pub(super) scalar: Scalar,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a number in binary.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether each of its numbers fits a 32-bit float.
    pub(super) fn fits_f32(self) -> bool {
        !matches!(self, Self::I32 | Self::U32 | Self::F64)
    }

    /// The largest number of the type.
    pub(super) fn most(self) -> u32 {
        match self {
            Self::I8 => 0x7f,
            Self::U8 => 0xff,
            Self::I16 => 0x7fff,
            Self::U16 => 0xffff,
            Self::I32 => 0x7fff_ffff,
            _ => u32::MAX,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

impl<'a> Header<'a> {
    /// Reads the lines up to `end_header`.
    pub(super) fn parse(lines: &mut Lines<'a>) -> Result<Self, Error> {
        let first = lines.next().unwrap_or_default().trim_ascii();
        if first != b"ply" {
            let message = format!("expected the keyword ply of a PLY file, found {}", quoted(first));
            return Err(lines.refuse(message));
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        while let Some(line) = lines.next() {
            // Only comments have more than 5 words.
            let words: Vec<&[u8]> = Tokens(line).take(6).collect();
            match words[..] {
                [b"format", b"ascii", b"1.0"] => encoding = Some(Encoding::Ascii),
                [b"format", b"binary_little_endian", b"1.0"] => encoding = Some(Encoding::LittleEndian),
                [b"format", b"binary_big_endian", b"1.0"] => encoding = Some(Encoding::BigEndian),
                [b"element", name, digits] => {
                    let count =
                        integer(digits).and_then(|count| u64::try_from(count).ok()).ok_or_else(|| {
                            lines.refuse(format!("expected a number of elements, found {}", quoted(digits)))
                        })?;
                    elements.push(Element { name, count, digits, properties: Vec::new() });
                }
                [b"property", b"list", length, scalar, name] => {
                    let length = scalar_type(length, lines)?;
                    if !length.is_integer() {
                        return Err(lines.refuse("the length of a list must have an integer type"));
                    }
                    let scalar = scalar_type(scalar, lines)?;
                    property(&mut elements, lines)?.push(Property { name, length: Some(length), scalar });
                }
                [b"property", scalar, name] => {
                    let scalar = scalar_type(scalar, lines)?;
                    property(&mut elements, lines)?.push(Property { name, length: None, scalar });
                }
                [b"end_header"] => {
                    let encoding = encoding.ok_or_else(|| lines.refuse("the header has no line format"))?;
                    return Ok(Self { encoding, elements });
                }
                // Comments; some files write them without a keyword.
                [] => {}
                [word, ..] if !KEYWORDS.contains(&word) => {}
                _ => {
                    let found = quoted(line.trim_ascii());
                    return Err(lines.refuse(format!("expected a line of a PLY header, found {found}")));
                }
            }
        }
        Err(lines.refuse("the file ends before the line end_header"))
    }
}

fn scalar_type(name: &[u8], lines: &Lines) -> Result<Scalar, Error> {
    Scalar::named(name)
        .ok_or_else(|| lines.refuse(format!("expected a type such as float or int, found {}", quoted(name))))
}

/// The properties of the last element.
fn property<'e, 'a>(
    elements: &'e mut [Element<'a>],
    lines: &Lines,
) -> Result<&'e mut Vec<Property<'a>>, Error> {
    match elements.last_mut() {
        Some(element) => Ok(&mut element.properties),
        None => Err(lines.refuse("a property before the first element")),
    }
}

/// What the reader does with a property.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Role {
    Coordinate(usize),
    Polygon,
    Strip,
    Skipped,
}

/// The role of a property of an element with this name.
pub(super) fn role(element: &[u8], property: &Property) -> Role {
    match (element, property.name, property.length) {
        (b"vertex", b"x", None) => Role::Coordinate(0),
        (b"vertex", b"y", None) => Role::Coordinate(1),
        (b"vertex", b"z", None) => Role::Coordinate(2),
        (b"face", b"vertex_indices" | b"vertex_index", Some(_)) if property.scalar.is_integer() => {
            Role::Polygon
        }
        (b"tristrips", b"vertex_indices" | b"vertex_index", Some(_)) if property.scalar.is_integer() => {
            Role::Strip
        }
        _ => Role::Skipped,
    }
}
