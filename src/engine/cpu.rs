//! The phases on the CPU, one thread, over the frontier.

use super::{Answer, Census, EdgeCounts, Engine};
use crate::adjacency::unflagged;
use crate::locks;
use crate::mesh::{Dimension, Mesh};
use crate::phases::{Frontier, Geometry, Topology, Verdict, flag_creases, flip, label, select, verdict};
use crate::star::Fans;
use crate::winding::Winding;
use crate::{Adjacency, NONE};
use std::sync::Arc;

/// The state of a mesh between two iterations, and the scratch arrays of the phases.
pub(crate) struct Cpu {
    mesh: Arc<Mesh>,
    cos: f64,
    winding: Winding,
    counts: EdgeCounts,
    pub(crate) triangles: Vec<u32>,
    pub(crate) twins: Vec<u32>,
    pub(crate) fans: Fans,
    pub(crate) frontier: Frontier,
    pub(crate) best: Vec<u32>,
    pub(crate) selected: Vec<u32>,
    iteration: u32,
}

impl Cpu {
    /// Builds the adjacency; `cos` is the cosine of β.
    pub(crate) fn new(mesh: Arc<Mesh>, cos: f64) -> Self {
        let adjacency = Adjacency::new(&mesh);
        let winding = Winding::new(&mesh, &adjacency.twins);
        let counts = EdgeCounts::from(&adjacency);
        let triangles = mesh.triangles().to_vec();
        let fans = Fans::new(mesh.vertex_count(), &triangles, &adjacency.twins);
        let count = mesh.triangle_count();
        let mut twins = adjacency.twins;
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &triangles, &mut twins, cos);
        }
        Self {
            mesh,
            cos,
            winding,
            counts,
            triangles,
            twins,
            fans,
            frontier: Frontier::all(count as u32),
            best: vec![NONE; count],
            selected: vec![NONE; count],
            iteration: 0,
        }
    }

    pub(super) fn geometry(&self) -> Geometry<'_> {
        Geometry {
            dimension: self.mesh.dimension(),
            positions: self.mesh.positions(),
            cos: self.cos,
            winding: &self.winding,
        }
    }

    pub(super) fn topology(&self) -> Topology<'_> {
        Topology { triangles: &self.triangles, twins: &self.twins, fans: &self.fans }
    }

    /// Label for the triangles of the frontier.
    pub(crate) fn label(&mut self) {
        let mut best = std::mem::take(&mut self.best);
        let active = self.frontier.active.iter().copied();
        label(&self.geometry(), self.topology(), self.iteration, active, &mut best);
        self.best = best;
    }

    /// Select for the triangles of the frontier.
    pub(crate) fn select(&mut self) {
        let mut selected = std::mem::take(&mut self.selected);
        let active = self.frontier.active.iter().copied();
        select(self.topology(), self.iteration, active, &self.best, &mut selected);
        self.selected = selected;
    }

    /// Flip with Update, then the next frontier. Returns the number of flips.
    pub(crate) fn flip(&mut self) -> u32 {
        let Self { triangles, twins, fans, frontier, best, selected, .. } = self;
        let active = || frontier.active.iter().copied();
        let flipped = active().filter(|&t| selected[t as usize] != NONE).count() as u32 / 2;
        flip(triangles, twins, fans, selected, active());
        frontier.advance(self.iteration, twins, best, selected);
        self.iteration += 1;
        flipped
    }

    /// The verdict of every interior edge, counted.
    pub(crate) fn count(&self) -> Census {
        let mut census = Census::default();
        for h in 0..self.triangles.len() as u32 {
            let g = unflagged(self.twins[h as usize]);
            if g != NONE && h < g {
                match verdict(&self.geometry(), self.topology(), h) {
                    Verdict::Delaunay => {}
                    Verdict::Labelled => census.labelled += 1,
                    Verdict::Blocked(reason) => census.blocked[reason] += 1,
                }
            }
        }
        census
    }
}

impl Engine for Cpu {
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        locks::flag(&mut self.twins, &half_edges);
        Box::pin(std::future::ready(Ok(())))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        let mut flips = Vec::new();
        while (flips.len() as u32) < count {
            self.label();
            self.select();
            match self.flip() {
                0 => break,
                flipped => flips.push(flipped),
            }
        }
        Box::pin(std::future::ready(Ok(flips)))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(std::future::ready(Ok(self.count())))
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.triangles.clone())))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.twins.clone())))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()> {
        self.winding = Winding::new(&mesh, &self.twins);
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &self.triangles, &mut self.twins, self.cos);
        }
        self.frontier = Frontier::all(mesh.triangle_count() as u32);
        self.best.fill(NONE);
        self.selected.fill(NONE);
        self.iteration = 0;
        self.mesh = mesh;
        Box::pin(std::future::ready(Ok(())))
    }

    fn batch(&self) -> u32 {
        1
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> &'static str {
        "cpu"
    }
}

impl From<&Adjacency> for EdgeCounts {
    fn from(adjacency: &Adjacency) -> Self {
        let &Adjacency { edges, boundary, non_manifold, inconsistent, .. } = adjacency;
        Self { edges, boundary, non_manifold, inconsistent }
    }
}
