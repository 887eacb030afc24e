//! The chains of the lines: which vertices each line passes, and which lines pass each edge.

use crate::mesh::named_edges::ordered;
use crate::system::memory;
use crate::{Error, NONE};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};
use std::iter::successors;
use std::mem;

/// A vertex of a chain.
struct Link {
    vertex: u32,
    /// The next link of the chain, or [`NONE`].
    after: u32,
    line: u32,
    /// The next of the links from which a chain goes along the same edge, or [`NONE`].
    beside: u32,
}

/// What is known of an edge.
struct Edge {
    /// The first of the links from which a chain goes along the edge, or [`NONE`].
    links: u32,
    /// Whether the caller has locked it: then it stays as it is.
    is_fixed: bool,
}

/// A hash of two vertices. The standard one is made for keys that an attacker chooses, and takes several times as long.
#[derive(Default)]
struct PairHasher(u64);

impl Hasher for PairHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(byte.into()));
    }

    fn write_u64(&mut self, number: u64) {
        // Knuth's multiplicative hash. The table takes the lowest and the highest bits.
        let product = (self.0 ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = product ^ product >> 32;
    }
}

/// The two vertices of an edge in one number.
fn key(ends: [u32; 2]) -> u64 {
    let [u, v] = ordered(ends);
    u64::from(u) << 32 | u64::from(v)
}

pub(super) struct Chains {
    links: Vec<Link>,
    edges: HashMap<u64, Edge, BuildHasherDefault<PairHasher>>,
    /// The first link of each line, or [`NONE`].
    first: Vec<u32>,
    /// The last link of the present line.
    last: u32,
}

impl Chains {
    pub(super) fn new(lines: usize, fixed: impl Iterator<Item = [u32; 2]>) -> Self {
        let fixed = fixed.map(|ends| (key(ends), Edge { links: NONE, is_fixed: true }));
        Self { links: Vec::new(), edges: fixed.collect(), first: vec![NONE; lines], last: NONE }
    }

    /// Makes sure that there is memory for more links.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    fn reserve(&mut self, more: usize) -> Result<(), Error> {
        if self.links.capacity() - self.links.len() < more || self.edges.capacity() - self.edges.len() < 2 {
            let links = (2 * self.links.capacity()).max(self.links.len() + more);
            let edges = 4 * self.edges.capacity() + 16;
            memory::check((links * size_of::<Link>() + edges * size_of::<(u64, Edge)>()) as u64)?;
            self.links.reserve(more);
            self.edges.reserve(2);
        }
        Ok(())
    }

    /// Begins the chain of a line.
    pub(super) fn begin(&mut self, line: u32, vertex: u32) -> Result<(), Error> {
        self.reserve(1)?;
        self.last = self.links.len() as u32;
        self.first[line as usize] = self.last;
        self.links.push(Link { vertex, after: NONE, line, beside: NONE });
        Ok(())
    }

    /// The present line goes on along an edge to a vertex.
    pub(super) fn extend(&mut self, vertex: u32) -> Result<(), Error> {
        self.reserve(1)?;
        let (from, to) = (self.last, self.links.len() as u32);
        let Link { vertex: at, line, .. } = self.links[from as usize];
        self.links.push(Link { vertex, after: NONE, line, beside: NONE });
        self.links[from as usize].after = to;
        self.last = to;
        self.add([at, vertex], from);
        Ok(())
    }

    /// The present line goes on from another copy of the same vertex.
    pub(super) fn jump(&mut self, vertex: u32) -> Result<(), Error> {
        let Link { vertex: at, line, .. } = self.links[self.last as usize];
        if at == vertex {
            return Ok(());
        }
        self.reserve(1)?;
        let to = self.links.len() as u32;
        self.links.push(Link { vertex, after: NONE, line, beside: NONE });
        self.links[self.last as usize].after = to;
        self.last = to;
        Ok(())
    }

    /// Notes that a chain goes along an edge from a link.
    fn add(&mut self, ends: [u32; 2], link: u32) {
        let edge = match self.edges.entry(key(ends)) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Edge { links: NONE, is_fixed: false }),
        };
        self.links[link as usize].beside = mem::replace(&mut edge.links, link);
    }

    /// Whether an edge is one of chains only, so that it may change.
    pub(super) fn may_change(&self, ends: [u32; 2]) -> bool {
        self.edges.get(&key(ends)).is_some_and(|edge| !edge.is_fixed)
    }

    fn along(&self, ends: [u32; 2]) -> impl Iterator<Item = u32> {
        let first = self.edges.get(&key(ends)).map_or(NONE, |edge| edge.links);
        let present = |link: u32| (link != NONE).then_some(link);
        successors(present(first), move |&link| present(self.links[link as usize].beside))
    }

    /// The first line that passes an edge.
    pub(super) fn first_line(&self, ends: [u32; 2]) -> Option<u32> {
        self.along(ends).map(|link| self.links[link as usize].line).min()
    }

    /// Leads all chains of an edge through a vertex instead.
    pub(super) fn split(&mut self, ends: [u32; 2], vertex: u32) -> Result<(), Error> {
        let links: Vec<u32> = self.along(ends).collect();
        self.reserve(links.len())?;
        self.edges.remove(&key(ends));
        for from in links {
            let Link { vertex: at, after, line, .. } = self.links[from as usize];
            let middle = self.links.len() as u32;
            self.links.push(Link { vertex, after, line, beside: NONE });
            self.links[from as usize].after = middle;
            let to = self.links[after as usize].vertex;
            self.add([at, vertex], from);
            self.add([vertex, to], middle);
        }
        Ok(())
    }

    /// The vertices of a chain; none if the line was left out. `name` gives each vertex its number.
    pub(super) fn path(&self, line: usize, name: impl Fn(u32) -> u32) -> Vec<u32> {
        let present = |link: u32| (link != NONE).then_some(link);
        let links = successors(present(self.first[line]), |&link| present(self.links[link as usize].after));
        let mut path: Vec<u32> = links.map(|link| name(self.links[link as usize].vertex)).collect();
        path.dedup();
        path
    }
}
