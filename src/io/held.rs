//! The faces of a file that is held to be written again with other triangles. Each format says where its faces are, what
//! they and their corners have, and how it writes a triangle.

use crate::system::threads::Threads;
use crate::{Adjacency, Error, Mesh, NONE, Wedges, reoriented};
use memchr::memchr2;
use std::borrow::Borrow;
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

/// Faces that are written by one thread at a time.
const FACES: usize = 1 << 14;

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

impl Faces<'_> {
    /// All faces, in lists for one thread each.
    pub(super) fn lists(&self) -> Vec<&[Face]> {
        self.lists.iter().flat_map(|list| list.chunks(FACES)).collect()
    }

    /// How many triangles each list has.
    pub(super) fn triangles(&self, threads: &Threads) -> Vec<usize> {
        threads.map_each(self.lists(), |list| list.iter().map(|face| face.triangles).sum())
    }

    /// The group of each triangle; nothing if there is only one.
    pub(super) fn groups(&self) -> Vec<u32> {
        let mut faces = self.lists.iter().flatten();
        let Some(first) = faces.next() else { return Vec::new() };
        if faces.all(|face| face.group == first.group) {
            return Vec::new();
        }
        let faces = self.lists.iter().flatten();
        faces.flat_map(|face| std::iter::repeat_n(face.group, face.triangles)).collect()
    }

    /// The wedges of the mesh as it is and, where triangles are turned against each other, as [`reoriented`] turns them.
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
