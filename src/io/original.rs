//! A held OFF, OBJ, PLY or STL file: written again with other triangles, and with everything else unchanged.

use super::attributes::AttributeEdges;
use super::format::Format;
use super::held::{Face, Faces};
use super::parsed::Others;
use super::{obj, off, pieces, ply, stl, text};
use crate::{Error, Mesh, Options};
use std::borrow::Cow;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

/// A file as it was read, unpacked and without UTF-16.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Original {
    pub(super) format: Format,
    pub(super) bytes: Vec<u8>,
    /// The most bytes that it may have, also when it is written again.
    pub(super) max_bytes: u64,
    /// The number of its triangles, if neither its faces nor their corners have attributes.
    pub(super) plain: Option<usize>,
    pub(super) others: Others,
    /// The names of the attributes of faces and corners that lock no edges.
    pub(super) ignored: Vec<String>,
}

/// Bytes that a thread writes between two checks of the total.
const COUNTED: usize = 1 << 16;

impl Original {
    /// Adds the locks that keep the attributes to `options`, and returns the locked edges.
    pub(super) fn constrain(&self, mesh: &Mesh, options: &mut Options) -> Result<AttributeEdges, Error> {
        if self.plain == Some(mesh.triangle_count()) {
            return Ok(AttributeEdges::default());
        }
        self.faces(mesh)?.lock(mesh, &self.ignored, options)
    }

    /// Refuses ignored attributes that the file does not have.
    pub(super) fn check_ignored(&self, mesh: &Mesh) -> Result<(), Error> {
        if self.ignored.is_empty() { Ok(()) } else { self.faces(mesh)?.check(&self.ignored) }
    }

    /// The bytes of the file with the triangles of `after`, in parts. Faces without a changed triangle stay; other
    /// faces are replaced by their triangles.
    pub(super) fn with_triangles(&self, mesh: &Mesh, after: &Mesh) -> Result<Vec<Cow<'_, [u8]>>, Error> {
        let threads = pieces::threads(self.bytes.len());
        let faces = &self.faces(mesh)?;
        let corners = faces.carried(mesh, after)?;
        let lists = faces.lists();
        let start = lists.first().map_or(self.bytes.len(), |list| list[0].bytes.start);
        let ends = lists.iter().skip(1).map(|list| list[0].bytes.start).chain([self.bytes.len()]);
        let mut first = 0;
        let pieces = lists.iter().zip(ends).zip(faces.triangles(&threads)).map(|((list, end), count)| {
            first += count;
            Piece { list, first: first - count, end }
        });
        let rewriting = Rewriting {
            original: self,
            faces,
            triangles: [mesh, after].map(|mesh| mesh.triangles().as_chunks().0),
            corners: corners.iter().map(|numbers| numbers.as_chunks().0).collect(),
            length: AtomicU64::new(start as u64),
        };
        let parts = threads.map_each(pieces.collect(), |piece| rewriting.piece(&piece));
        // This error comes before all others, so that the error does not depend on the number of threads.
        rewriting.refuse_too_long()?;
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        let more: u64 = parts.iter().map(|(_, more)| more).sum();
        let (mut all, mut copied) = (Vec::new(), 0);
        for count in faces.counts.iter().filter(|_| more > 0) {
            all.push(Cow::Borrowed(&self.bytes[copied..count.start]));
            let number = text::integer(&self.bytes[count.clone()]).unwrap_or_default();
            // The number of edges in a file may be wrong.
            all.push(Cow::Owned(number.saturating_add_unsigned(more).to_string().into_bytes()));
            copied = count.end;
        }
        all.push(Cow::Borrowed(&self.bytes[copied..start]));
        all.extend(parts.into_iter().map(|(bytes, _)| Cow::Owned(bytes)));
        Ok(all)
    }

    fn faces<'a>(&'a self, mesh: &'a Mesh) -> Result<Faces<'a>, Error> {
        let bytes = &self.bytes;
        let faces = match self.format {
            Format::Off => off::held_faces(bytes),
            Format::Obj => Ok(obj::held_faces(bytes, mesh, &self.others, &self.ignored)),
            Format::Ply => ply::held_faces(bytes, mesh, &self.others, &self.ignored),
            _ => Ok(stl::held_faces(bytes, mesh)),
        }?;
        let expected = 3 * faces.triangles(&pieces::threads(bytes.len())).iter().sum::<usize>();
        let length = mesh.triangles().len();
        if length == expected { Ok(faces) } else { Err(Error::TriangleCount { length, expected }) }
    }
}

/// Consecutive faces to write.
struct Piece<'a> {
    list: &'a [Face],
    /// The index of their first triangle.
    first: usize,
    /// The end of the bytes after them, up to the next piece.
    end: usize,
}

/// A file being written again.
struct Rewriting<'a> {
    original: &'a Original,
    faces: &'a Faces<'a>,
    /// The triangles before and after.
    triangles: [&'a [[u32; 3]]; 2],
    /// The numbers of the corners for each of [`Faces::corners`].
    corners: Vec<&'a [[u32; 3]]>,
    /// Bytes that all threads have written. It only grows, so the result of the check does not depend on their order.
    length: AtomicU64,
}

impl Rewriting<'_> {
    /// The bytes of a piece, and how many faces it has in addition.
    fn piece(&self, piece: &Piece) -> Result<(Vec<u8>, u64), Error> {
        let (bytes, [before, after]) = (&self.original.bytes, self.triangles);
        let mut copied = piece.list[0].bytes.start;
        let mut out = Vec::with_capacity(piece.end - copied);
        let (mut counted, mut more, mut next) = (0, 0, piece.first);
        let mut corners = Vec::new();
        for face in piece.list {
            let triangles = next..next + face.triangles;
            next = triangles.end;
            if before[triangles.clone()] == after[triangles.clone()] {
                continue;
            }
            out.extend_from_slice(&bytes[copied..face.bytes.start]);
            copied = face.bytes.end;
            more += face.triangles as u64 - 1;
            let (start, values) = (triangles.start, &self.faces.groups[face.group as usize]);
            for triangle in triangles {
                if triangle > start {
                    out.extend_from_slice(self.faces.separator);
                }
                corners.clear();
                corners.extend(self.corners.iter().map(|numbers| numbers[triangle]));
                (self.faces.write)(&mut out, values, after[triangle], &corners)?;
                // Each triangle repeats the attributes of its polygon.
                if out.len() >= counted + COUNTED {
                    self.length.fetch_add((out.len() - counted) as u64, Relaxed);
                    counted = out.len();
                    self.refuse_too_long()?;
                }
            }
        }
        out.extend_from_slice(&bytes[copied..piece.end]);
        self.length.fetch_add((out.len() - counted) as u64, Relaxed);
        Ok((out, more))
    }

    fn refuse_too_long(&self) -> Result<(), Error> {
        let limit = self.original.max_bytes;
        if self.length.load(Relaxed) > limit {
            return Err(Error::FileTooLarge { limit, option: "max_bytes" });
        }
        Ok(())
    }
}
