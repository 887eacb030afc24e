//! A file that is held to be written again with other triangles, and all else as it was: what OFF, OBJ, PLY and STL
//! share of that. A format says where its faces are, what they and their corners have, and how it writes a triangle.

use super::{Format, obj, off, pieces, ply, stl};
use crate::session::locks;
use crate::system::threads::Threads;
use crate::{Adjacency, Error, Mesh, NONE, Options, Wedges, reoriented};
use memchr::memchr2;
use std::borrow::{Borrow, Cow};
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

/// A file as it was read, unpacked and without UTF-16.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Original {
    pub(super) format: Format,
    pub(super) bytes: Vec<u8>,
    /// Bytes that it may have, also when it is written again.
    pub(super) max_bytes: u64,
    /// Its triangles, where it is known that neither its faces nor their corners have attributes.
    pub(super) plain: Option<usize>,
}

/// Faces that are written by one thread at a time.
const FACES: usize = 1 << 14;

/// Bytes that one thread writes before all are counted again.
const COUNTED: usize = 1 << 16;

/// The faces of a file, in its order.
pub(super) struct Faces<'a> {
    /// Lists that follow each other.
    pub(super) lists: Vec<Vec<Face>>,
    /// A number for each corner of their triangles, equal at corners of a vertex of which the file says the same; empty
    /// where it says nothing of any.
    pub(super) corners: Vec<u32>,
    /// Numbers of the header that grow with the number of faces.
    pub(super) counts: Vec<Range<usize>>,
    /// What stands between two faces.
    pub(super) separator: &'a [u8],
    /// Writes a triangle of that group: its vertices, and the numbers of its corners, 0 where they have none.
    pub(super) write: Write<'a>,
}

type Write<'a> = Box<dyn Fn(&mut Vec<u8>, u32, [u32; 3], [u32; 3]) -> Result<(), Error> + Sync + 'a>;

/// A face that makes triangles.
pub(super) struct Face {
    /// Where it is, without what ends it.
    pub(super) bytes: Range<usize>,
    /// How many triangles it is cut into.
    pub(super) triangles: usize,
    /// Equal where what the file says of the faces is.
    pub(super) group: u32,
}

impl Original {
    /// Adds to `options` what keeps the attributes where they are, and returns how many edges that locks.
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
            // What divides the triangles in one way or in the other.
            let mut numbers = Numbers::default();
            for (group, own) in options.groups.iter_mut().zip(own.groups) {
                *group = numbers.of(&(*group, own));
            }
        }
        Ok(locked.len())
    }

    /// The bytes of the file of `mesh` with the triangles of `after`, as many, in parts. Faces of which no triangle is
    /// another stay as they are; the others give way to their triangles.
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
        // First of all errors, so that it is the same for any number of threads.
        rewriting.refuse_too_long()?;
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        let more: u64 = parts.iter().map(|(_, more)| more).sum();
        let (mut all, mut copied) = (Vec::new(), 0);
        for count in faces.counts.iter().filter(|_| more > 0) {
            all.push(Cow::Borrowed(&self.bytes[copied..count.start]));
            let number = super::text::integer(&self.bytes[count.clone()]).unwrap_or_default();
            // That of edges can be any.
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
            Format::Obj => Ok(obj::held_faces(bytes, mesh)),
            Format::Ply => ply::held_faces(bytes, mesh),
            _ => Ok(stl::held_faces(bytes, mesh)),
        }?;
        let expected = 3 * faces.triangles(&pieces::threads(bytes.len())).iter().sum::<usize>();
        let length = mesh.triangles().len();
        if length == expected { Ok(faces) } else { Err(Error::TriangleCount { length, expected }) }
    }
}

/// Faces that follow each other, on their way into another file.
struct Piece<'a> {
    list: &'a [Face],
    /// The number of their first triangle.
    first: usize,
    /// Where what follows them ends.
    end: usize,
}

/// A file that is written again.
struct Rewriting<'a> {
    original: &'a Original,
    faces: &'a Faces<'a>,
    /// Before and after, and the numbers of the corners.
    triangles: [&'a [[u32; 3]]; 3],
    /// Bytes that have been written by all threads. It only grows, so what it refuses does not depend on who is first.
    length: AtomicU64,
}

impl Rewriting<'_> {
    /// The bytes of a piece, and how many faces it has more.
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
                // What a polygon has, each of its triangles has.
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

impl Faces<'_> {
    /// All faces, in lists for one thread each.
    fn lists(&self) -> Vec<&[Face]> {
        self.lists.iter().flat_map(|list| list.chunks(FACES)).collect()
    }

    /// How many triangles each list has.
    fn triangles(&self, threads: &Threads) -> Vec<usize> {
        threads.map_each(self.lists(), |list| list.iter().map(|face| face.triangles).sum())
    }

    /// The group of each triangle; nothing if there is only one.
    fn groups(&self) -> Vec<u32> {
        let mut faces = self.lists.iter().flatten();
        let Some(first) = faces.next() else { return Vec::new() };
        if faces.all(|face| face.group == first.group) {
            return Vec::new();
        }
        let faces = self.lists.iter().flatten();
        faces.flat_map(|face| std::iter::repeat_n(face.group, face.triangles)).collect()
    }

    /// The wedges of the mesh as it is and, where triangles are turned against each other, as [`reoriented`] turns them.
    fn wedges(&self, mesh: &Mesh) -> Result<Vec<Wedges>, Error> {
        if self.corners.is_empty() {
            return Ok(Vec::new());
        }
        let mut all = vec![Wedges::new(mesh, self.corners.clone())?];
        if Adjacency::new(mesh).inconsistent > 0 {
            let (turned, count) = reoriented(mesh)?;
            if count > 0 {
                let mut corners = self.corners.clone();
                let triangles = [mesh, &turned].map(|mesh| mesh.triangles().as_chunks::<3>().0);
                for (t, corners) in corners.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                    if triangles[0][t] != triangles[1][t] {
                        corners.swap(1, 2);
                    }
                }
                all.push(Wedges::new(&turned, corners)?);
            }
        }
        Ok(all)
    }

    /// The number of each corner of the triangles `after`.
    fn carried(&self, mesh: &Mesh, after: &Mesh) -> Result<Vec<u32>, Error> {
        let mut wedges = self.wedges(mesh)?;
        let Some(mut last) = wedges.pop() else { return Ok(Vec::new()) };
        // No flip makes triangles agree that did not: they were turned before, or not.
        if let Some(first) = wedges.pop() {
            let inconsistent = |mesh: &Mesh| Adjacency::new(mesh).inconsistent;
            if inconsistent(mesh) == inconsistent(after) {
                last = first;
            }
        }
        last.carried(after.triangles())
    }
}

/// Numbers from 0, equal for equal keys.
pub(super) struct Numbers<K> {
    numbers: HashMap<K, u32>,
    /// The keys by their numbers.
    known: Vec<K>,
    /// The number given last: often the next one is the same.
    last: u32,
}

impl<K> Default for Numbers<K> {
    fn default() -> Self {
        Self { numbers: HashMap::new(), known: Vec::new(), last: 0 }
    }
}

impl<K: Clone + Eq + Hash> Numbers<K> {
    pub(super) fn of<Q>(&mut self, key: &Q) -> u32
    where
        K: Borrow<Q>,
        Q: ToOwned<Owned = K> + Eq + Hash + ?Sized,
    {
        if self.known.get(self.last as usize).is_none_or(|last| last.borrow() != key) {
            self.last = self.numbers.get(key).copied().unwrap_or_else(|| {
                let number = self.known.len() as u32;
                self.known.push(key.to_owned());
                self.numbers.insert(key.to_owned(), number);
                number
            });
        }
        self.last
    }

    /// The keys by their numbers.
    pub(super) fn into_known(self) -> Vec<K> {
        self.known
    }
}

/// Numbers for what the corners of a mesh have, from 0, and what each number stands for: equal at corners of a vertex
/// whose keys are.
pub(super) fn numbered<T: Copy + PartialEq, K: Eq + Hash>(
    mesh: &Mesh,
    corners: &[T],
    mut key: impl FnMut(T) -> K,
) -> (Vec<u32>, Vec<T>) {
    let mut known: Vec<T> = Vec::new();
    // Most vertices have one for all their corners.
    let mut first = vec![NONE; mesh.vertex_count()];
    let mut others = HashMap::new();
    let numbers = mesh.triangles().iter().zip(corners).map(|(&vertex, &corner)| {
        let first = &mut first[vertex as usize];
        if known.get(*first as usize).is_some_and(|&first| first == corner || key(first) == key(corner)) {
            return *first;
        }
        let next = known.len() as u32;
        let number = if *first == NONE {
            *first = next;
            next
        } else {
            *others.entry((vertex, key(corner))).or_insert(next)
        };
        if number == next {
            known.push(corner);
        }
        number
    });
    (numbers.collect(), known)
}

/// Where `part` is in `file`, a part of which it has to be.
pub(super) fn place(file: &[u8], part: &[u8]) -> Range<usize> {
    let start = part.as_ptr() as usize - file.as_ptr() as usize;
    start..start + part.len()
}

/// How the first line of a text ends.
pub(super) fn line_end(text: &[u8]) -> &[u8] {
    match memchr2(b'\n', b'\r', text).map(|end| &text[end..]) {
        Some(end) if end.starts_with(b"\r\n") => &end[..2],
        Some(end) => &end[..1],
        None => b"\n",
    }
}
