//! The faces of a held file, which can be written again with other triangles. Each format provides the byte ranges of
//! its faces, the attributes of faces and corners, and a function that writes a triangle.

use super::parsed::Others;
use crate::system::threads::Threads;
use crate::{Adjacency, Error, Mesh, NONE, Wedges, reoriented};
use memchr::memchr2;
use std::borrow::Borrow;
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

/// The most faces of one piece of work.
const FACES: usize = 1 << 14;

/// The faces of a file, in its order.
pub(super) struct Faces<'a> {
    /// Consecutive lists.
    pub(super) lists: Vec<Vec<Face>>,
    /// A number for each corner of their triangles. Two corners of a vertex have the same number if they have the same
    /// attributes. Empty if no corner has attributes.
    pub(super) corners: Vec<u32>,
    /// Byte ranges of the numbers in the header that grow with the number of faces.
    pub(super) counts: Vec<Range<usize>>,
    /// The bytes between two faces.
    pub(super) separator: &'a [u8],
    /// Writes a triangle: its group, its vertices, and the numbers of its corners, 0 if `corners` is empty.
    pub(super) write: Write<'a>,
}

type Write<'a> = Box<dyn Fn(&mut Vec<u8>, u32, [u32; 3], [u32; 3]) -> Result<(), Error> + Sync + 'a>;

/// A face that makes triangles.
pub(super) struct Face {
    /// Its byte range, without a line end.
    pub(super) bytes: Range<usize>,
    /// The number of triangles that it is cut into.
    pub(super) triangles: usize,
    /// A number, equal for faces with the same attributes.
    pub(super) group: u32,
}

impl Faces<'_> {
    /// All faces, in lists of at most [`FACES`].
    pub(super) fn lists(&self) -> Vec<&[Face]> {
        self.lists.iter().flat_map(|list| list.chunks(FACES)).collect()
    }

    /// The number of triangles of each list.
    pub(super) fn triangles(&self, threads: &Threads) -> Vec<usize> {
        threads.map_each(self.lists(), |list| list.iter().map(|face| face.triangles).sum())
    }

    /// The group of each triangle; empty if there is only one group.
    pub(super) fn groups(&self) -> Vec<u32> {
        let mut faces = self.lists.iter().flatten();
        let Some(first) = faces.next() else { return Vec::new() };
        if faces.all(|face| face.group == first.group) {
            return Vec::new();
        }
        let faces = self.lists.iter().flatten();
        faces.flat_map(|face| std::iter::repeat_n(face.group, face.triangles)).collect()
    }

    /// The wedges of the mesh and, if its orientation is inconsistent, those of the [`reoriented`] mesh.
    pub(super) fn wedges(&self, mesh: &Mesh) -> Result<Vec<Wedges>, Error> {
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
    pub(super) fn carried(&self, mesh: &Mesh, after: &Mesh) -> Result<Vec<u32>, Error> {
        let mut wedges = self.wedges(mesh)?;
        let Some(mut last) = wedges.pop() else { return Ok(Vec::new()) };
        // Flips do not change the number of inconsistent edges. If it is unchanged, no triangle was reversed.
        if let Some(first) = wedges.pop() {
            let inconsistent = |mesh: &Mesh| Adjacency::new(mesh).inconsistent;
            if inconsistent(mesh) == inconsistent(after) {
                last = first;
            }
        }
        last.carried(after.triangles())
    }
}

/// Numbers keys from 0. Equal keys have the same number.
pub(super) struct Numbers<K> {
    numbers: HashMap<K, u32>,
    /// The keys by their numbers.
    known: Vec<K>,
    /// The last number: often the next one is the same.
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

/// Numbers the attributes of the corners of a mesh, from 0, and returns the attributes of each number. Corners of a
/// vertex with equal keys have the same number.
pub(super) fn numbered<T: Copy + PartialEq, K: Eq + Hash>(
    mesh: &Mesh,
    corners: &[T],
    mut key: impl FnMut(T) -> K,
) -> (Vec<u32>, Vec<T>) {
    let mut known: Vec<T> = Vec::new();
    // Most vertices have one number for all their corners.
    let mut first = vec![NONE; mesh.vertex_count()];
    let mut further = HashMap::new();
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
            *further.entry((vertex, key(corner))).or_insert(next)
        };
        if number == next {
            known.push(corner);
        }
        number
    });
    (numbers.collect(), known)
}

/// The corners of the triangles that the faces are cut into, face by face.
pub(super) struct Corners<'a> {
    others: std::iter::Peekable<std::slice::Iter<'a, (u32, Vec<[usize; 3]>)>>,
    /// The number of triangles so far.
    triangles: usize,
}

impl<'a> Corners<'a> {
    pub(super) fn new(others: &'a Others) -> Self {
        Self { others: others.iter().peekable(), triangles: 0 }
    }

    /// The corners of each of the triangles of the next face.
    pub(super) fn of_next(&mut self, triangles: usize) -> impl Iterator<Item = usize> + use<'a> {
        let first = self.triangles;
        self.triangles += triangles;
        let other = self.others.next_if(|(at, _)| *at as usize == first);
        let other = other.map(|(_, triangles)| triangles.as_flattened());
        let fan = if other.is_some() { 1..1 } else { 1..triangles + 1 };
        other.unwrap_or_default().iter().copied().chain(fan.flat_map(|i| [0, i, i + 1]))
    }
}

/// The byte range of `part` in `file`. `part` must be a slice of `file`.
pub(super) fn range_in(file: &[u8], part: &[u8]) -> Range<usize> {
    let start = part.as_ptr() as usize - file.as_ptr() as usize;
    start..start + part.len()
}

/// The line end of the first line of a text.
pub(super) fn line_end(text: &[u8]) -> &[u8] {
    match memchr2(b'\n', b'\r', text).map(|end| &text[end..]) {
        Some(end) if end.starts_with(b"\r\n") => &end[..2],
        Some(end) => &end[..1],
        None => b"\n",
    }
}
