//! The components of a mesh in the plane, with the rings of their boundaries.

use crate::mesh::half_edge::{next, triangle_of, unflagged};
use crate::mesh::star::{Fans, Star};
use crate::mesh::winding::Outline;
use crate::predicates::area_sign;
use crate::{Mesh, NONE};
use glam::{DVec2, dvec2};
use rstar::{AABB, RTree, RTreeObject};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// A boundary edge, in the direction of its triangle, with the vertex before it in its ring.
#[derive(Clone, Copy)]
pub(super) struct Side {
    pub(super) before: u32,
    pub(super) ends: [u32; 2],
    pub(super) ring: u32,
    /// Rings with a common vertex are a group.
    pub(super) group: u32,
}

/// A component of a mesh.
pub(super) struct Component<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) is_clockwise: bool,
    pub(super) sides: Vec<Side>,
    pub(super) rings: usize,
    pub(super) groups: usize,
    pub(super) triangles: Vec<u32>,
    pub(super) vertices: Vec<u32>,
    /// Vertices that have several fans in the mesh, each once for each closed fan in this component.
    pub(super) closed: Vec<u32>,
    /// The sides by position, made when they are needed.
    pub(super) tree: OnceCell<RTree<Located>>,
}

/// A boundary edge for searches by position.
pub(super) struct Located {
    pub(super) ends: [DVec2; 2],
    pub(super) side: usize,
}

impl RTreeObject for Located {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let [p, q] = self.ends;
        AABB::from_corners(p.min(q).into(), p.max(q).into())
    }
}

pub(super) fn components<'a>(mesh: &'a Mesh, twins: &[u32]) -> Vec<Component<'a>> {
    let outline = Outline::new(mesh.triangles(), twins);
    let winding = outline.winding(mesh);
    let mut components: Vec<Component> = Vec::new();
    for (t, &component) in (0..).zip(outline.components()) {
        if component as usize == components.len() {
            let is_clockwise = winding.is_clockwise(t);
            let [triangles, vertices, closed] = Default::default();
            components.push(Component {
                mesh,
                is_clockwise,
                sides: Vec::new(),
                rings: 0,
                groups: 0,
                triangles,
                vertices,
                closed,
                tree: OnceCell::new(),
            });
        }
        components[component as usize].triangles.push(t);
    }
    let mut is_visited = vec![false; twins.len()];
    for first in (0..twins.len() as u32).filter(|&h| twins[h as usize] == NONE) {
        if is_visited[first as usize] {
            continue;
        }
        let component = &mut components[outline.components()[triangle_of(first) as usize] as usize];
        let (mut h, start) = (first, component.sides.len());
        while !std::mem::replace(&mut is_visited[h as usize], true) {
            let ends = [h, next(h)].map(|x| mesh.triangles()[x as usize]);
            let ring = component.rings as u32;
            let before = component.sides.last().map_or(NONE, |side| side.ends[0]);
            component.sides.push(Side { before, ends, ring, group: ring });
            h = next(h);
            while twins[h as usize] != NONE {
                h = next(unflagged(twins[h as usize]));
            }
        }
        let last = component.sides.last().map_or(NONE, |side| side.ends[0]);
        component.sides[start].before = last;
        component.rings += 1;
    }
    let fans = Fans::new(mesh.vertex_count(), mesh.triangles(), twins).table;
    for &h in fans.get(mesh.vertex_count()..).unwrap_or_default() {
        if h == NONE {
            continue;
        }
        if Star::of_fan(twins, h).all(|corner| twins[corner as usize] != NONE) {
            let component = outline.components()[triangle_of(h) as usize] as usize;
            components[component].closed.push(mesh.triangles()[h as usize]);
        }
    }
    for component in &mut components {
        let corners = component.triangles.iter().flat_map(|t| 3 * t..3 * t + 3);
        component.vertices = corners.map(|h| mesh.triangles()[h as usize]).collect();
        component.vertices.sort_unstable();
        component.vertices.dedup();
        component.closed.sort_unstable();
        component.join_rings();
    }
    components
}

impl Component<'_> {
    /// A vertex, in a mirror if the component is clockwise: then its triangles should turn left, too.
    pub(super) fn point(&self, v: u32) -> DVec2 {
        let point = self.mesh.point2(v);
        // A negative zero is at the point of a zero.
        dvec2(point.x, if self.is_clockwise { -point.y } else { point.y }) + DVec2::ZERO
    }

    /// The side of the line from u to v on which w lies: positive inside.
    pub(super) fn turn(&self, corners: [u32; 3]) -> Ordering {
        let [a, b, c] = corners.map(|v| self.point(v));
        area_sign(a, b, c)
    }

    /// Gives rings with a common vertex the same group.
    fn join_rings(&mut self) {
        let mut groups: Vec<u32> = (0..self.rings as u32).collect();
        let group = |groups: &mut [u32], mut ring: u32| {
            while groups[ring as usize] != ring {
                groups[ring as usize] = groups[groups[ring as usize] as usize];
                ring = groups[ring as usize];
            }
            ring
        };
        let mut of_vertices: Vec<[u32; 2]> =
            self.sides.iter().map(|side| [side.ends[0], side.group]).collect();
        of_vertices.sort_unstable();
        for pair in of_vertices.windows(2).filter(|pair| pair[0][0] == pair[1][0]) {
            let [one, other] = [pair[0][1], pair[1][1]].map(|ring| group(&mut groups, ring));
            groups[one.max(other) as usize] = one.min(other);
        }
        self.sides.iter_mut().for_each(|side| side.group = group(&mut groups, side.group));
        self.groups = (0..).zip(&groups).filter(|(ring, group)| ring == *group).count();
    }

    pub(super) fn tree(&self) -> &RTree<Located> {
        self.tree.get_or_init(|| {
            let located = |(side, Side { ends, .. }): (usize, &Side)| Located {
                ends: ends.map(|v| self.point(v)),
                side,
            };
            RTree::bulk_load(self.sides.iter().enumerate().map(located).collect())
        })
    }
}
