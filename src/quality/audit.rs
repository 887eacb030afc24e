//! The audit: checks what a result must keep of its input, and lists the edges that remain, with exact arithmetic. It
//! shares no code with the engines, except `cos_degrees`, which defines cos β.

use super::audit_exact;
use super::edges::{Class, Edge};
use super::paths::{Line, Named, Paths, take_path};
use super::surface::{Limits, RemainingEdge, Surface};
use crate::{Dimension, Error, Mesh, Options, Outcome, Reason, Reasons, Session, cos_degrees};
use std::cmp::Ordering;

/// The most violations that an [`Audit`] lists. It only counts the others.
pub const MAX_LISTED: usize = 100;

/// A difference between a result and its input that must not be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// The number of vertex indices changed.
    #[error("{after} vertex indices instead of {before}")]
    Length {
        /// In the input.
        before: usize,
        /// In the result.
        after: usize,
    },
    /// A vertex index is out of range.
    #[error("triangle {triangle}: vertex index {index} is out of range")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The index found.
        index: u32,
    },
    /// A boundary edge appeared, disappeared or was reversed.
    #[error("boundary edge {u}-{v} changed")]
    Boundary {
        /// Smaller end.
        u: u32,
        /// Larger end.
        v: u32,
    },
    /// A frozen edge changed: one that is not manifold or not consistently oriented.
    #[error("frozen edge {u}-{v} changed")]
    Frozen {
        /// Smaller end.
        u: u32,
        /// Larger end.
        v: u32,
    },
    /// An edge has more half-edges than before, and more than two.
    #[error("edge {u}-{v} has {half_edges} half-edges")]
    NewNonManifold {
        /// Smaller end.
        u: u32,
        /// Larger end.
        v: u32,
        /// The number of its half-edges in the result.
        half_edges: usize,
    },
    /// An edge has two half-edges in the same direction, and had not before.
    #[error("edge {u}-{v} has two half-edges in the same direction")]
    NewInconsistent {
        /// Smaller end.
        u: u32,
        /// Larger end.
        v: u32,
    },
    /// Triangles use a vertex only before or only after the run.
    #[error("vertex {vertex} is used only in the input or only in the result")]
    Vertex {
        /// Index of the vertex.
        vertex: usize,
    },
    /// The Euler characteristic changed.
    #[error("Euler characteristic {after} instead of {before}")]
    Euler {
        /// In the input.
        before: i64,
        /// In the result.
        after: i64,
    },
    /// The number of edge-connected components changed.
    #[error("{after} components instead of {before}")]
    Components {
        /// In the input.
        before: usize,
        /// In the result.
        after: usize,
    },
    /// A crease is missing: an edge whose normals differed by more than β in the input (3D).
    #[error("crease {u}-{v} is missing")]
    Crease {
        /// Smaller end.
        u: u32,
        /// Larger end.
        v: u32,
    },
    /// A locked edge is missing.
    #[error("locked edge {u}-{v} is missing")]
    Locked {
        /// Smaller end.
        u: u32,
        /// Larger end.
        v: u32,
    },
    /// A constraint is no path of edges along its line, as far as the tolerance allows, or an edge of its path is missing.
    #[error("constraint {u}-{v} is missing")]
    Constraint {
        /// Its first vertex.
        u: u32,
        /// Its second vertex.
        v: u32,
    },
    /// The signed areas of the components, sorted, are not exactly the same (2D).
    #[error("the signed area of a component changed")]
    Area,
    /// More triangles than before are flat or inverted (2D). An inverted triangle has the opposite sign of its
    /// component.
    #[error("{after} inverted or flat triangles instead of {before}")]
    Inverted {
        /// In the input.
        before: usize,
        /// In the result.
        after: usize,
    },
}

/// The result of [`audit`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audit {
    /// The first [`MAX_LISTED`] violations.
    pub violations: Vec<Violation>,
    /// The number of further violations.
    pub unlisted: usize,
    /// Every edge of the result that is not Delaunay, in ascending order of its ends. An edge is a pair of vertices,
    /// however many triangles share it. Empty if the indices are wrong.
    pub remaining_edges: Vec<RemainingEdge>,
    /// The number of these edges, by reason.
    pub remaining: Reasons,
    /// The triangles of the result that are turned over, as [`Outcome::inverted`](crate::Outcome::inverted) counts
    /// them, in ascending order. Empty in space, and if the indices are wrong.
    pub inverted: Vec<u32>,
    /// The triangles of no area, in ascending order. Empty if the indices are wrong.
    pub flat: Vec<u32>,
}

impl Audit {
    /// Whether there are no violations, and no triangle is turned over. Remaining edges and flat triangles do not count.
    ///
    /// A triangle that is turned over is no violation: it was so before the run, or no flip could turn it back. A result
    /// without violations is right for its input.
    pub fn is_clean(&self) -> bool {
        self.violations.is_empty() && self.inverted.is_empty()
    }

    /// The ends of the edges that remain for `reason`, in ascending order.
    pub fn remaining_for(&self, reason: Reason) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.remaining_edges.iter().filter(move |edge| edge.reason == reason).map(|edge| [edge.u, edge.v])
    }

    fn report(&mut self, violation: Violation) {
        if self.violations.len() < MAX_LISTED {
            self.violations.push(violation);
        } else {
            self.unlisted += 1;
        }
    }

    fn compare<T: PartialEq>(&mut self, before: T, after: T, violation: impl FnOnce(T, T) -> Violation) {
        if before != after {
            self.report(violation(before, after));
        }
    }
}

/// Checks `triangles` as a result of flipping edges of `input` with these options, exactly. It has its own edge table,
/// components and arithmetic. Locks of edges that `input` does not have are ignored.
///
/// It searches for the paths of edges that the constraints have become. Constraints may be missing if the options skip
/// them, and where a mesh overlaps, a constraint may have several paths, of which the run has locked one.
/// [`audit_outcome`] knows more.
pub fn audit(input: &Mesh, triangles: &[u32], options: &Options) -> Audit {
    audit_named(input, triangles, options, None)
}

/// As [`audit`], for the result of a run on `input`. The outcome names the edges of each constraint, which are checked:
/// they have to be a path along its line, and none may be missing. Only a constraint that the outcome lists as left out,
/// and a locked edge that it lists as lost, may be missing.
pub fn audit_outcome(input: &Mesh, outcome: &Outcome, options: &Options) -> Audit {
    let left_out = outcome.left_out.iter().map(|left| left.index).collect();
    let named = Named { edges: &outcome.constraint_edges, left_out, lost_edges: &outcome.lost_edges };
    audit_named(input, &outcome.triangles, options, Some(named))
}

pub(crate) fn audit_named(input: &Mesh, triangles: &[u32], options: &Options, named: Option<Named>) -> Audit {
    let mut audit = Audit::default();
    audit.compare(input.triangles().len(), triangles.len(), |before, after| Violation::Length {
        before,
        after,
    });
    for (i, &index) in triangles.iter().enumerate() {
        if index as usize >= input.vertex_count() {
            audit.report(Violation::IndexOutOfRange { triangle: i / 3, index });
        }
    }
    if !audit.is_clean() {
        return audit;
    }
    let limits = Limits {
        cosine: cos_degrees(options.max_normal_angle),
        deviation: rounded_down(options.max_deviation),
    };
    let before = Surface::new(input, input.triangles());
    let after = Surface::new(input, triangles);
    let creases = compare_edges(&mut audit, &before, &after, limits.cosine);
    compare_vertices(&mut audit, &before, &after);
    audit.compare(before.euler(), after.euler(), |before, after| Violation::Euler { before, after });
    audit.compare(before.areas.len(), after.areas.len(), |before, after| Violation::Components {
        before,
        after,
    });
    [audit.inverted, audit.flat] = after.inverted_and_flat();
    if input.dimension() == Dimension::Two {
        audit.compare(before.sorted_areas(), after.sorted_areas(), |_, _| Violation::Area);
        let before = before.inverted_and_flat().map(|list| list.len()).iter().sum();
        let after = audit.inverted.len() + audit.flat.len();
        if after > before {
            audit.report(Violation::Inverted { before, after });
        }
    }
    let mut locked = locked(&before, options);
    if let Some(Named { lost_edges, .. }) = named {
        locked.retain(|&(u, v)| lost_edges.binary_search(&[u, v]).is_err());
    }
    for &(u, v) in locked.iter().filter(|&&(u, v)| !after.table.contains(u, v)) {
        audit.report(Violation::Locked { u, v });
    }
    add_constraints(&mut audit, &mut locked, &after, options, named);
    audit.remaining_edges = after.remaining(limits, &creases, &locked);
    audit.remaining = audit.remaining_edges.iter().map(|edge| edge.reason).collect();
    audit
}

impl Session {
    /// The audit of the present triangles.
    ///
    /// # Errors
    /// [`Error::Device`]; after updates, those of [`Session::set_positions`].
    pub async fn verify(&mut self) -> Result<Audit, Error> {
        self.come_to_rest().await?;
        let triangles = self.triangles().await?;
        let (mesh, options) = self.input();
        let left_out = self.left_out().iter().map(|left| left.index).collect();
        // The options have forgotten the locked edges that the mesh has lost.
        let named = Named { edges: self.constraint_edges(), left_out, lost_edges: &[] };
        Ok(audit_named(mesh, &triangles, options, Some(named)))
    }
}

/// The largest 32-bit float that is not larger than `x`.
fn rounded_down(x: f64) -> f64 {
    let nearest = x as f32;
    f64::from(if f64::from(nearest) > x { nearest.next_down() } else { nearest })
}

/// The edges that `options` lock, in the order of the table.
fn locked(before: &Surface, options: &Options) -> Vec<(u32, u32)> {
    let Options { locked_edges, locked_triangles, groups, .. } = options;
    let mut named: Vec<_> = locked_edges.iter().map(|&[u, v]| (u.min(v), u.max(v))).collect();
    named.sort_unstable();
    let mut is_locked = vec![false; before.triangle_count()];
    for &t in locked_triangles {
        if let Some(is_locked) = is_locked.get_mut(t as usize) {
            *is_locked = true;
        }
    }
    let group = |h: u32| groups.get(h as usize / 3);
    let is_locked = |edge: &Edge| {
        let mut half_edges = edge.half_edges();
        let first = half_edges.clone().next().and_then(group);
        named.binary_search(&(edge.u, edge.v)).is_ok()
            || half_edges.any(|h| is_locked[h as usize / 3] || group(h) != first)
    };
    before.table.edges().filter(is_locked).map(|edge| (edge.u, edge.v)).collect()
}

/// Adds the edges of the constraints to `locked`, and reports the constraints that are missing.
fn add_constraints(
    audit: &mut Audit,
    locked: &mut Vec<(u32, u32)>,
    after: &Surface,
    options: &Options,
    named: Option<Named>,
) {
    let constraints = options.constraints.iter();
    let line = |ends| Line { ends, tolerance: options.constraint_tolerance };
    let mut add = |path: &[[u32; 2]]| locked.extend(path.iter().map(|&[u, v]| (u.min(v), u.max(v))));
    if let Some(Named { mut edges, left_out, .. }) = named {
        let is_left_out = |i| options.skips_constraints && left_out.binary_search(&i).is_ok();
        for (_, &[u, v]) in constraints.enumerate().filter(|&(i, _)| !is_left_out(i)) {
            let path = take_path(after, &mut edges, line([u, v])).unwrap_or_default();
            add(path);
            if path.is_empty() || path.iter().any(|&[u, v]| !after.table.contains(u, v)) {
                audit.report(Violation::Constraint { u, v });
            }
        }
    } else if !options.constraints.is_empty() {
        let mut paths = Paths::new(after);
        for &[u, v] in constraints {
            match paths.along(line([u, v])) {
                Some(path) => add(&path),
                None if options.skips_constraints => {}
                None => audit.report(Violation::Constraint { u, v }),
            }
        }
    }
    locked.sort_unstable();
    locked.dedup();
}

/// Compares both tables in step. Only edges between two consistent triangles may appear and disappear, and creases may
/// not disappear. Returns the creases, in the order of the tables.
fn compare_edges(audit: &mut Audit, before: &Surface, after: &Surface, cosine: f64) -> Vec<(u32, u32)> {
    let mut creases = Vec::new();
    let (mut old_edges, mut new_edges) = (before.table.edges().peekable(), after.table.edges().peekable());
    loop {
        let (old, new) = match (old_edges.peek(), new_edges.peek()) {
            (None, None) => return creases,
            (Some(_), None) => (old_edges.next(), None),
            (None, Some(_)) => (None, new_edges.next()),
            (Some(old), Some(new)) => match (old.u, old.v).cmp(&(new.u, new.v)) {
                Ordering::Less => (old_edges.next(), None),
                Ordering::Equal => (old_edges.next(), new_edges.next()),
                Ordering::Greater => (None, new_edges.next()),
            },
        };
        if let Some(violation) = changed(old, new) {
            audit.report(violation);
        }
        if let (Dimension::Three, Some(Edge { u, v, class: Class::Twins(h, g), .. })) =
            (before.mesh.dimension(), old)
        {
            let [first, second] = [h, g].map(|x| before.triangle_of(x));
            if audit_exact::normals_differ(first, second, cosine) {
                creases.push((u, v));
                if new.is_none() {
                    audit.report(Violation::Crease { u, v });
                }
            }
        }
    }
}

/// The violation at one edge, if any.
fn changed(old: Option<Edge>, new: Option<Edge>) -> Option<Violation> {
    // An edge that may flip counts as absent, since it may appear or disappear.
    let signature = |edge: Option<Edge>| match edge {
        None | Some(Edge { class: Class::Twins(..), .. }) => None,
        Some(edge) => Some((edge.class, edge.directed)),
    };
    if signature(old) == signature(new) {
        return None;
    }
    let Edge { u, v, .. } = old.or(new)?;
    let [was, is] = [old, new].map(|edge| edge.map_or([0, 0], |edge| edge.directed));
    let half_edges = is[0] + is[1];
    let boundary = |edge: Option<Edge>| edge.is_some_and(|edge| edge.class == Class::Boundary);
    Some(if half_edges > 2.max(was[0] + was[1]) {
        Violation::NewNonManifold { u, v, half_edges }
    } else if (0..2).any(|k| is[k] >= 2 && was[k] < 2) {
        Violation::NewInconsistent { u, v }
    } else if boundary(old) || boundary(new) {
        Violation::Boundary { u, v }
    } else {
        Violation::Frozen { u, v }
    })
}

fn compare_vertices(audit: &mut Audit, before: &Surface, after: &Surface) {
    let (before, after) = (before.used(), after.used());
    for (vertex, (before, after)) in before.into_iter().zip(after).enumerate() {
        audit.compare(before, after, |_, _| Violation::Vertex { vertex });
    }
}
