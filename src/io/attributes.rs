//! The attributes of the faces and corners of a held file: the edges that they lock, and what new triangles have.

use super::held::{CornerAttribute, Faces, Numbers};
use super::text::quoted;
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::next;
use crate::session::locks;
use crate::{Adjacency, Error, Mesh, NONE, Options, Wedges, reoriented};
use std::cmp::Reverse;
use std::collections::HashMap;

/// The edges that [`Loaded::constrain`](super::Loaded::constrain) locks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AttributeEdges {
    /// How many there are.
    pub count: usize,
    /// The attributes that lock edges, and how many edges each locks: the largest number first. Several attributes may
    /// lock the same edge. The names are those of [`ReadOptions::ignore_attributes`](super::ReadOptions).
    pub by_name: Vec<(String, usize)>,
}

impl Faces<'_> {
    /// Refuses names of attributes that the file does not have.
    ///
    /// # Errors
    /// [`Error::Option`], with the names that the file has.
    pub(super) fn check(&self, ignored: &[String]) -> Result<(), Error> {
        let has = |i: usize| self.groups.iter().any(|values| !values[i].is_empty());
        let of_faces = self.names.iter().enumerate().filter(|&(i, _)| has(i)).map(|(_, name)| name);
        let mut names = Numbers::<String>::default();
        for name in self.corners.iter().map(|corner| &corner.name).chain(of_faces) {
            names.of(name.as_str());
        }
        refuse_unknown(ignored, &names.into_known())
    }

    /// Adds the locks of all attributes that are not ignored to `options`, and returns the edges that they lock.
    pub(super) fn lock(
        &self,
        mesh: &Mesh,
        ignored: &[String],
        options: &mut Options,
    ) -> Result<AttributeEdges, Error> {
        let (mut all, mut by_name) = (Vec::new(), Vec::new());
        let kept: Vec<_> = self.corners.iter().filter(|corner| !corner.is_ignored).collect();
        let turned = if kept.is_empty() { None } else { turned(mesh)? };
        for corner in kept {
            let mut own = Options::default();
            let meshes = [Some(mesh), turned.as_ref()];
            for oriented in meshes.into_iter().flatten() {
                let wedges = Wedges::new(oriented, corner.numbers_in(mesh, oriented))?;
                own.locked_edges.extend_from_slice(wedges.locked_edges());
                own.locked_triangles.extend_from_slice(wedges.locked_triangles());
            }
            let edges = sorted(locks::edges(mesh, &own)?);
            options.locked_edges.append(&mut own.locked_edges);
            options.locked_triangles.append(&mut own.locked_triangles);
            all.extend_from_slice(&edges);
            by_name.push((corner.name.as_str(), edges));
        }
        let borders = self.lock_borders(mesh, ignored, options, &by_name);
        all.extend_from_slice(&borders.edges);
        let mut by_name: Vec<_> =
            by_name.into_iter().map(|(name, edges)| (name.to_owned(), edges.len())).collect();
        let seams = by_name.len();
        for (name, count) in borders.by_name {
            match by_name[..seams].iter_mut().find(|(known, _)| *known == name) {
                Some((_, known)) => *known += count,
                None => by_name.push((name, count)),
            }
        }
        by_name.retain(|&(_, count)| count > 0);
        by_name.sort_by_key(|&(_, count)| Reverse(count));
        Ok(AttributeEdges { count: sorted(all).len(), by_name })
    }

    /// Divides the groups of `options`, so that their borders are where attributes of faces differ that are not ignored.
    /// Counts an edge for a name unless it is among the edges of `seams` with this name.
    fn lock_borders(
        &self,
        mesh: &Mesh,
        ignored: &[String],
        options: &mut Options,
        seams: &[(&str, Vec<[u32; 2]>)],
    ) -> Borders {
        let mut names = Numbers::<String>::default();
        let kept: Vec<(usize, u32)> = (0..self.names.len())
            .filter(|&i| !ignored.contains(&self.names[i]))
            .map(|i| (i, names.of(self.names[i].as_str())))
            .collect();
        let names = names.into_known();
        let mut borders = Borders { edges: Vec::new(), by_name: Vec::new() };
        let (mut numbers, mut values) = (Numbers::<Vec<&[u8]>>::default(), Vec::new());
        let divisions = (0..).zip(&self.groups).map(|(group, own)| {
            if kept.len() == self.names.len() {
                return group;
            }
            values.clear();
            values.extend(kept.iter().map(|&(i, _)| own[i]));
            numbers.of(values.as_slice())
        });
        let divisions: Vec<u32> = divisions.collect();
        if divisions.iter().all(|&division| division == 0) {
            return borders;
        }
        let faces = self.lists.iter().flatten();
        let groups: Vec<u32> =
            faces.flat_map(|face| std::iter::repeat_n(face.group, face.triangles)).collect();
        let seams: Vec<_> = names
            .iter()
            .map(|name| seams.iter().find(|(seam, _)| seam == name).map(|(_, edges)| edges))
            .collect();
        // For each name, its edges, and the last of them.
        let mut counts = vec![(0, 0); names.len()];
        for_each_edge(mesh.vertex_count(), mesh.triangles(), |half_edges| {
            let group = |h: u32| groups[h as usize / 3] as usize;
            let first = group(half_edges[0]);
            if half_edges.iter().all(|&h| divisions[group(h)] == divisions[first]) {
                return;
            }
            let mut edge = [half_edges[0], next(half_edges[0])].map(|h| mesh.triangles()[h as usize]);
            edge.sort_unstable();
            borders.edges.push(edge);
            for &(i, name) in &kept {
                let (count, last) = &mut counts[name as usize];
                let differs = |&h: &u32| self.groups[group(h)][i] != self.groups[first][i];
                if *last < borders.edges.len() && half_edges.iter().any(differs) {
                    *last = borders.edges.len();
                    let is_seam =
                        seams[name as usize].is_some_and(|edges| edges.binary_search(&edge).is_ok());
                    *count += usize::from(!is_seam);
                }
            }
        });
        borders.by_name = names.into_iter().zip(counts).map(|(name, (count, _))| (name, count)).collect();
        // Two triangles are in one group if both divisions have them in one group.
        let own = groups.iter().map(|&group| divisions[group as usize]);
        if options.groups.is_empty() {
            options.groups = own.collect();
        } else {
            let mut numbers = Numbers::default();
            for (group, own) in options.groups.iter_mut().zip(own) {
                *group = numbers.of(&(*group, own));
            }
        }
        borders
    }

    /// For each of [`Faces::corners`], the numbers of the corners of the triangles `after`.
    pub(super) fn carried(&self, mesh: &Mesh, after: &Mesh) -> Result<Vec<Vec<u32>>, Error> {
        if self.corners.is_empty() {
            return Ok(Vec::new());
        }
        // Flips do not change the number of inconsistent edges. If it is unchanged, no triangle was reversed.
        let inconsistent = |mesh: &Mesh| Adjacency::new(mesh).inconsistent;
        let turned = turned(mesh)?.filter(|_| inconsistent(mesh) != inconsistent(after));
        let before = turned.as_ref().unwrap_or(mesh);
        let carried = self.corners.iter().map(|corner| {
            let numbers = corner.numbers_in(mesh, before);
            if corner.is_ignored {
                Ok(replaced(before, &numbers, corner.absent, after))
            } else {
                Wedges::new(before, numbers)?.carried(after.triangles())
            }
        });
        carried.collect()
    }
}

/// The edges between the groups, and how many each name locks besides its seams.
struct Borders {
    edges: Vec<[u32; 2]>,
    by_name: Vec<(String, usize)>,
}

/// Refuses names that are not among `names`.
///
/// # Errors
/// [`Error::Option`].
pub(super) fn refuse_unknown(ignored: &[String], names: &[String]) -> Result<(), Error> {
    let Some(unknown) = ignored.iter().find(|name| !names.contains(name)) else { return Ok(()) };
    let listed: Vec<_> = names.iter().map(|name| quoted(name.as_bytes())).collect();
    let listed = if names.is_empty() { "none".to_owned() } else { listed.join(", ") };
    let message = format!(
        "no attribute of faces or corners is named {}; the file has: {listed}",
        quoted(unknown.as_bytes())
    );
    Err(Error::Option { option: "ignore_attributes", message })
}

/// The ends of each edge in ascending order, each edge once, in ascending order.
fn sorted(mut edges: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    edges.iter_mut().for_each(|ends| ends.sort_unstable());
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The [`reoriented`] mesh, if triangles were reversed.
fn turned(mesh: &Mesh) -> Result<Option<Mesh>, Error> {
    if Adjacency::new(mesh).inconsistent == 0 {
        return Ok(None);
    }
    let (turned, count) = reoriented(mesh)?;
    Ok((count > 0).then_some(turned))
}

impl CornerAttribute {
    /// The numbers of the corners of `oriented`, which is the mesh, perhaps with some triangles reversed.
    fn numbers_in(&self, mesh: &Mesh, oriented: &Mesh) -> Vec<u32> {
        let mut numbers = self.numbers.clone();
        let [triangles, oriented] = [mesh, oriented].map(|mesh| mesh.triangles().as_chunks::<3>().0);
        for (numbers, (own, turned)) in
            numbers.as_chunks_mut::<3>().0.iter_mut().zip(triangles.iter().zip(oriented))
        {
            if own != turned {
                numbers.swap(1, 2);
            }
        }
        numbers
    }
}

/// The numbers of the corners of `after` for an attribute that locks no edge. A triangle whose corners have one value
/// keeps it. Else a corner gets the value that its vertex had in an old triangle on the same side of one of the two
/// edges there, if possible the one that is replaced, or else in the first triangle that has a value there.
fn replaced(before: &Mesh, numbers: &[u32], absent: Option<u32>, after: &Mesh) -> Vec<u32> {
    let is_value = |number: &u32| Some(*number) != absent;
    let mut firsts = vec![NONE; before.vertex_count()];
    for (&vertex, number) in before.triangles().iter().zip(numbers).filter(|(_, number)| is_value(number)) {
        let first = &mut firsts[vertex as usize];
        if *first == NONE {
            *first = *number;
        }
    }
    let [old, new] = [before, after].map(|mesh| mesh.triangles().as_chunks::<3>().0);
    let numbers = numbers.as_chunks::<3>().0;
    // For each half-edge of a changed triangle, the numbers at its two ends.
    let mut sides = HashMap::new();
    for ((old, new), numbers) in old.iter().zip(new).zip(numbers) {
        for (k, l) in [(0, 1), (1, 2), (2, 0)] {
            if old != new {
                sides.entry([old[k], old[l]]).or_insert([numbers[k], numbers[l]]);
            }
        }
    }
    let replaced = old.iter().zip(new).zip(numbers).map(|((old, new), &own)| {
        if old == new || own == [own[0]; 3] {
            return own;
        }
        [0, 1, 2].map(|k| {
            let [vertex, next, previous] = [k, k + 1, k + 2].map(|k| new[k % 3]);
            let is_beside =
                |&j: &usize| old[j] == vertex && (old[(j + 1) % 3] == next || old[(j + 2) % 3] == previous);
            let beside = (0..3).find(is_beside).map(|j| own[j]);
            let after = sides.get(&[vertex, next]).map(|side| side[0]);
            let before = sides.get(&[previous, vertex]).map(|side| side[1]);
            let first = Some(firsts[vertex as usize]).filter(|&first| first != NONE);
            let found = [beside, after, before, first].into_iter().flatten().chain(own).find(is_value);
            found.unwrap_or(own[k])
        })
    });
    replaced.flatten().collect()
}
