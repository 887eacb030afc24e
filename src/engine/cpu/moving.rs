//! Updates on the CPU: the vertices move, and the edges flip again.

use super::engine::Cpu;
use crate::engine::Moved;
use crate::mesh::areas::Areas;
use crate::mesh::embedded::{Embedded, Shape};
use crate::mesh::half_edge::unflagged;
use crate::phases::{Diamond, flag_creases, is_finite};
use crate::untangle::Frame;
use crate::{Dimension, NONE, Positions};
use glam::DVec2;
use std::borrow::Cow;

/// An update that flips less than one edge for so many triangles flips few.
const FEW: usize = 16;

impl Cpu {
    /// Takes over new positions: untangles a mesh in the plane if asked to, tests the stars and the creases again, and
    /// forgets the lists.
    pub(super) fn move_to(&mut self, positions: Option<Positions>, untangles: bool) {
        let Self { mesh, arrangement, thresholds, triangles, twins, threads, moving, .. } = self;
        if let Some(positions) = positions {
            moving.positions = Some(arrangement.arranged(Cow::Owned(positions), threads));
        }
        let positions = moving.positions.as_ref().unwrap_or(mesh.positions());
        moving.has_infinite = !positions.are_finite(threads);
        if mesh.dimension() == Dimension::Two {
            (self.winding.is_strict, self.embedded) = Default::default();
            // If few edges flip, searching their stars for duplicates is faster than finding the embedded stars.
            let finds_embedded = moving.last_flips > triangles.len() / 3 / FEW;
            if finds_embedded {
                self.find_embedded();
            }
            if untangles && !self.winding.is_strict && self.untangle() && finds_embedded {
                self.find_embedded();
            }
        } else {
            flag_creases(positions, triangles, twins, thresholds.cos, moving.has_infinite, threads);
        }
        self.settle(Vec::new(), false);
    }

    fn find_embedded(&mut self) {
        let Self { mesh, winding, embedded, triangles, twins, threads, moving, .. } = self;
        let positions = moving.positions.as_ref().unwrap_or(mesh.positions());
        let (shape, vertices) = (Shape { positions, triangles, twins }, mesh.vertex_count());
        let (signs, found) =
            Embedded::of_triangles(shape, vertices, Some(winding), moving.has_infinite, threads);
        winding.is_strict = signs.not_positive == 0;
        *embedded = found;
    }

    /// Replaces triangles that have turned over, as far as the rounds of an update do. Returns whether some have changed.
    fn untangle(&mut self) -> bool {
        let Self { mesh, arrangement, winding, fans, triangles, twins, threads, moving, .. } = self;
        let positions = moving.positions.as_ref().unwrap_or(mesh.positions());
        let is_left: fn([DVec2; 3]) -> bool = |points| !points.iter().all(|point| point.is_finite());
        let (is_left, written) = (moving.has_infinite.then_some(is_left), Vec::new());
        let mut frame = Frame { positions, triangles, twins, fans, winding, arrangement, is_left, written };
        frame.untangle(mesh.vertex_count(), threads);
        let written = frame.written;
        for &slot in &written {
            if let Some(changed) = moving.changes.get_mut(slot as usize) {
                *changed = moving.updates;
            }
        }
        !written.is_empty()
    }

    pub(super) fn add_flips(&mut self, flips: usize) {
        self.moving.flips += flips as u64;
        self.moving.last_flips = flips;
    }

    pub(super) fn count_areas(&self) -> Areas {
        let Self { mesh, winding, triangles, threads, moving, .. } = self;
        let shape = (mesh.dimension(), self.geometry().positions, &triangles[..]);
        Areas::of(shape, winding, moving.has_infinite, threads)
    }

    pub(super) fn count_moved(&mut self) -> Moved {
        let census = self.count();
        let Self { twins, moving, .. } = &*self;
        let geometry = self.geometry();
        let mut infinite = 0;
        if moving.has_infinite {
            let lower = |&h: &u32| h < unflagged(twins[h as usize]) && twins[h as usize] != NONE;
            let edges = (0..twins.len() as u32).filter(lower);
            let is_left = |&h: &u32| !is_finite(&geometry, Diamond::new(self.topology(), h).vertices);
            infinite = edges.filter(is_left).count() as u32;
        }
        Moved { census, infinite, wide: 0, flips: moving.flips, areas: self.count_areas() }
    }
}
