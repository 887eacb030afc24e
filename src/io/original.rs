//! A held OFF, OBJ, PLY or STL file: written again with other triangles, and with everything else unchanged.

use super::format::Format;
use super::held::{Face, Faces, Numbers};
use super::parsed::Others;
use super::{obj, off, pieces, ply, stl, text};
use crate::session::locks;
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
}

/// Bytes that a thread writes between two checks of the total.
const COUNTED: usize = 1 << 16;

impl Original {
    /// Adds the locks that keep the attributes to `options`, and returns the number of locked edges.
    pub(super) fn constrain(&self, mesh: &Mesh, options: &mut Options) -> Result<usize, Error> {
        if self.plain == Some(mesh.triangle_count()) {
            return Ok(0);
        }
        let faces = self.faces(mesh)?;
        let mut own = Options { groups: faces.groups(), ..Options::default() };
        for wedges in faces.wedges(mesh)? {
            own.locked_edges.extend_from_slice(wedges.locked_edges());
            own.locked_triangles.extend_from_slice(wedges.locked_triangles());
        }
        let mut locked = locks::edges(mesh, &own)?;
        locked.iter_mut().for_each(|ends| ends.sort_unstable());
        locked.sort_unstable();
        locked.dedup();
        options.locked_edges.append(&mut own.locked_edges);
        options.locked_triangles.append(&mut own.locked_triangles);
        if options.groups.is_empty() {
            options.groups = own.groups;
        } else {
            // Two triangles are in one group if both divisions have them in one group.
            let mut numbers = Numbers::default();
            for (group, own) in options.groups.iter_mut().zip(own.groups) {
                *group = numbers.of(&(*group, own));
            }
        }
        Ok(locked.len())
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
            triangles: [mesh.triangles(), after.triangles(), &corners].map(|numbers| numbers.as_chunks().0),
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
            Format::Obj => Ok(obj::held_faces(bytes, mesh, &self.others)),
            Format::Ply => ply::held_faces(bytes, mesh, &self.others),
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
    /// The triangles before and after, and the numbers of the corners.
    triangles: [&'a [[u32; 3]]; 3],
    /// Bytes that all threads have written. It only grows, so the result of the check does not depend on their order.
    length: AtomicU64,
}

impl Rewriting<'_> {
    /// The bytes of a piece, and how many faces it has in addition.
    fn piece(&self, piece: &Piece) -> Result<(Vec<u8>, u64), Error> {
        let (bytes, [before, after, corners]) = (&self.original.bytes, self.triangles);
        let mut copied = piece.list[0].bytes.start;
        let mut out = Vec::with_capacity(piece.end - copied);
        let (mut counted, mut more, mut next) = (0, 0, piece.first);
        for face in piece.list {
            let triangles = next..next + face.triangles;
            next = triangles.end;
            if before[triangles.clone()] == after[triangles.clone()] {
                continue;
            }
            out.extend_from_slice(&bytes[copied..face.bytes.start]);
            copied = face.bytes.end;
            more += face.triangles as u64 - 1;
            let start = triangles.start;
            for triangle in triangles {
                if triangle > start {
                    out.extend_from_slice(self.faces.separator);
                }
                let corners = corners.get(triangle).copied().unwrap_or_default();
                (self.faces.write)(&mut out, face.group, after[triangle], corners)?;
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
