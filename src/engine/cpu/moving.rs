//! Updates on the CPU: the vertices move, and the edges flip again.

use super::engine::Cpu;
use crate::engine::Moved;
use crate::mesh::areas::Areas;
use crate::mesh::embedded::{Embedded, Shape};
use crate::mesh::half_edge::unflagged;
use crate::phases::{Diamond, flag_creases, is_finite};
use crate::{Dimension, NONE, Positions};
use std::borrow::Cow;

/// An update that flips less than one edge for so many triangles flips few.
const FEW: usize = 16;

impl Cpu {
    /// Takes over new positions: tests the stars and the creases again, and forgets the lists.
    pub(super) fn move_to(&mut self, positions: Option<Positions>) {
        let Self { mesh, arrangement, thresholds, winding, embedded, .. } = self;
        let Self { triangles, twins, threads, moving, .. } = self;
        if let Some(positions) = positions {
            moving.positions = Some(arrangement.arranged(Cow::Owned(positions), threads));
        }
        let positions = moving.positions.as_ref().unwrap_or(mesh.positions());
        moving.has_infinite = !positions.are_finite(threads);
        if mesh.dimension() == Dimension::Two {
            // If few edges flip, searching their stars for duplicates is faster than finding the embedded stars.
            if moving.last_flips > triangles.len() / 3 / FEW {
                let shape = Shape { positions, triangles, twins };
                let (vertices, may_be_left) = (mesh.vertex_count(), moving.has_infinite);
                let (signs, found) =
                    Embedded::of_triangles(shape, vertices, Some(winding), may_be_left, threads);
                winding.is_strict = signs.not_positive == 0;
                *embedded = found;
            } else {
                winding.is_strict = false;
                *embedded = Embedded::default();
            }
        } else {
            flag_creases(positions, triangles, twins, thresholds.cos, moving.has_infinite, threads);
        }
        self.settle(Vec::new(), false);
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
