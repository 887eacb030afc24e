//! The faces of a held file, which can be written again with other triangles. Each format provides the byte ranges of
//! its faces, the attributes of faces and corners, and a function that writes a triangle.

use super::parsed::Others;
use crate::system::threads::Threads;
use crate::{Error, Mesh, NONE};
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
    /// The names of the attributes of faces.
    pub(super) names: Vec<String>,
    /// The values of these attributes in each group of faces, by its number; empty for none.
    pub(super) groups: Vec<Vec<&'a [u8]>>,
    /// The attributes of corners.
    pub(super) corners: Vec<CornerAttribute>,
    /// Byte ranges of the numbers in the header that grow with the number of faces.
    pub(super) counts: Vec<Range<usize>>,
    /// The bytes between two faces.
    pub(super) separator: &'a [u8],
    /// Writes a triangle.
    pub(super) write: Write<'a>,
}

/// Writes a triangle: the values of its group, its vertices, and for each of [`Faces::corners`] the numbers of its three
/// corners.
type Write<'a> = Box<dyn Fn(&mut Vec<u8>, &[&[u8]], [u32; 3], &[[u32; 3]]) -> Result<(), Error> + Sync + 'a>;

/// A face that makes triangles.
pub(super) struct Face {
    /// Its byte range, without a line end.
    pub(super) bytes: Range<usize>,
    /// The number of triangles that it is cut into.
    pub(super) triangles: usize,
    /// The number of its group: faces with the same attributes.
    pub(super) group: u32,
}

/// An attribute of the corners of triangles.
pub(super) struct CornerAttribute {
    pub(super) name: String,
    /// Whether edges may flip where it differs.
    pub(super) is_ignored: bool,
    /// A number for each corner of the triangles. Two corners of a vertex have the same number if they have the same
    /// value; if the attribute is ignored, all corners with the same value.
    pub(super) numbers: Vec<u32>,
    /// The number of corners without a value, if there are such corners.
    pub(super) absent: Option<u32>,
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

/// An attribute with a value for each corner of a mesh, and the values by their numbers. Values with the same key count
/// as the same. `T::default()` means that there is no value. `None` if no corner has a value.
pub(super) fn of_corners<T: Copy + Default + PartialEq, K: Eq + Hash>(
    mesh: &Mesh,
    name: &str,
    values: &[T],
    ignored: &[String],
    mut key: impl FnMut(T) -> K,
) -> Option<(CornerAttribute, Vec<T>)> {
    if values.iter().all(|value| *value == T::default()) {
        return None;
    }
    let is_ignored = ignored.iter().any(|ignored| ignored == name);
    let mut known: Vec<T> = Vec::new();
    // Most vertices have one number for all their corners.
    let mut first = vec![NONE; mesh.vertex_count()];
    let mut further = HashMap::new();
    let numbers = mesh.triangles().iter().zip(values).map(|(&vertex, &value)| {
        let first = &mut first[if is_ignored { 0 } else { vertex as usize }];
        if known.get(*first as usize).is_some_and(|&first| first == value || key(first) == key(value)) {
            return *first;
        }
        let next = known.len() as u32;
        let number = if *first == NONE {
            *first = next;
            next
        } else {
            *further.entry((if is_ignored { 0 } else { vertex }, key(value))).or_insert(next)
        };
        if number == next {
            known.push(value);
        }
        number
    });
    let numbers = numbers.collect();
    let absent = known.iter().position(|value| *value == T::default()).map(|number| number as u32);
    Some((CornerAttribute { name: name.to_owned(), is_ignored, numbers, absent }, known))
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
