//! The report of a run: one JSON object, or a few aligned lines.

use crate::args::Args;
use crate::failure::Failure;
use crate::points::Points;
use crate::times::Milliseconds;
use crate::words::{FLAT, INVERTED, change, first, first_edges, kept, reasons, short};
use edgeflip::io::{AttributeEdges, Format, Loaded};
use edgeflip::quality::{self, Measures};
use edgeflip::{
    Dimension, Error, LeftOut, Mesh, Outcome, Plane, Positions, Reasons, SplitCrossings, Status, Welded,
};
use indicatif::{HumanBytes, HumanCount};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// The keys of `--json`, in their order. Skipped fields are for the summary.
#[derive(Serialize)]
pub struct Report {
    input: String,
    vertices: usize,
    triangles: usize,
    edges: u64,
    boundary_edges: u64,
    non_manifold_edges: u64,
    inconsistent_edges: u64,
    dimension: usize,
    plane: Option<&'static str>,
    coordinates: u32,
    crossing_polygons: Vec<u32>,
    points: Option<Points>,
    backend: &'static str,
    adapter: Option<String>,
    fallback: Option<String>,
    status: &'static str,
    iterations: u32,
    flips: u64,
    crossed_edges: u64,
    new_vertices: usize,
    deviation: f64,
    left_out: Vec<LeftOut>,
    lost_edges: Vec<[u32; 2]>,
    flips_per_iteration: Vec<u32>,
    dispatches: u64,
    device_bytes: u64,
    remaining: BTreeMap<&'static str, u64>,
    inverted: u32,
    flat: u32,
    /// `null` if there is no angle.
    min_angle_before_deg: f64,
    min_angle_after_deg: f64,
    before: Shape,
    after: Shape,
    turned_triangles: u32,
    joined_vertices: usize,
    seam_edges: usize,
    moved_triangles: usize,
    attribute_edges: usize,
    #[serde(serialize_with = "as_object")]
    attribute_edges_by_name: Vec<(String, usize)>,
    pub ms: Milliseconds,
    #[serde(flatten)]
    check: Option<Check>,
    #[serde(skip)]
    has_heights: bool,
    #[serde(skip)]
    left: Reasons,
    #[serde(skip)]
    notes: Vec<String>,
}

/// The shape of the mesh; `null` for NaN or infinity.
#[derive(Serialize)]
struct Shape {
    min_angle_deg: f64,
    mean_min_angle_deg: f64,
    mean_aspect: f64,
    flat_triangles: usize,
    area: f64,
    volume: f64,
}

impl From<Measures> for Shape {
    fn from(measures: Measures) -> Self {
        let Measures { min_angle, mean_min_angle, mean_aspect, flat, area, volume } = measures;
        Self {
            min_angle_deg: min_angle,
            mean_min_angle_deg: mean_min_angle,
            mean_aspect,
            flat_triangles: flat,
            area,
            volume,
        }
    }
}

/// What `--verify` adds.
#[derive(Serialize)]
pub struct Check {
    #[serde(rename = "audit")]
    pub violations: Vec<String>,
    /// Whether there are no violations, and no triangle is turned over.
    pub clean: bool,
    /// The ends of the edges that are not Delaunay, by reason.
    pub remaining_edges: BTreeMap<&'static str, Vec<[u32; 2]>>,
    pub inverted_triangles: Vec<u32>,
    pub flat_triangles: Vec<u32>,
    /// How far the surface has moved.
    pub distance: f64,
}

impl Check {
    /// The failure of the program, if there are violations. `input` is for its message.
    pub fn violation(&self, input: &Path) -> Option<Failure> {
        let (first, more) = (self.violations.first()?, self.violations.len() - 1);
        let more = if more == 0 { String::new() } else { format!(" (and {more} more)") };
        Some(Failure { status: 1, line: format!("{}: the audit found: {first}{more}", input.display()) })
    }
}

/// The changes of the mesh by a run.
pub struct Changes {
    before: Measures,
    after: Measures,
    moved: usize,
}

impl Changes {
    /// Measures the mesh after the run.
    pub fn new(mesh: &Mesh, before: Measures, outcome: &Outcome) -> Result<Self, Error> {
        let result = mesh.with_triangles(outcome.triangles.clone())?;
        let moved = quality::moved(mesh.triangles(), result.triangles()).len();
        Ok(Self { before, after: quality::measures(&result), moved })
    }
}

impl Report {
    /// `turned`: the number of triangles that were reversed first.
    pub fn new(
        args: &Args,
        mesh: &Mesh,
        outcome: Outcome,
        Changes { before, after, moved }: Changes,
        turned: u32,
        check: Option<Check>,
        ms: Milliseconds,
    ) -> Self {
        Self {
            input: args.input.display().to_string(),
            vertices: mesh.vertex_count(),
            triangles: mesh.triangle_count(),
            edges: outcome.edges,
            boundary_edges: outcome.boundary_edges,
            non_manifold_edges: outcome.non_manifold_edges,
            inconsistent_edges: outcome.inconsistent_edges,
            dimension: mesh.dimension().stride(),
            plane: None,
            coordinates: if matches!(mesh.positions(), Positions::F64(_)) { 64 } else { 32 },
            crossing_polygons: Vec::new(),
            points: None,
            backend: outcome.backend.name(),
            adapter: outcome.adapter,
            fallback: outcome.fallback,
            status: match outcome.status {
                Status::Done => "done",
                Status::Stopped => "stopped",
            },
            iterations: outcome.iterations,
            flips: outcome.flips,
            crossed_edges: outcome.crossed_edges,
            new_vertices: 0,
            deviation: outcome.constraint_deviation,
            left_out: outcome.left_out,
            lost_edges: outcome.lost_edges,
            flips_per_iteration: outcome.flips_per_iteration,
            dispatches: outcome.dispatches,
            device_bytes: outcome.device_bytes,
            remaining: outcome.remaining.iter().map(|(reason, n)| (reason.name(), n)).collect(),
            inverted: outcome.inverted,
            flat: outcome.flat,
            min_angle_before_deg: before.min_angle,
            min_angle_after_deg: after.min_angle,
            before: before.into(),
            after: after.into(),
            turned_triangles: turned,
            joined_vertices: 0,
            seam_edges: 0,
            moved_triangles: moved,
            attribute_edges: 0,
            attribute_edges_by_name: Vec::new(),
            ms,
            check,
            has_heights: false,
            left: outcome.remaining,
            notes: Vec::new(),
        }
    }

    /// Adds the plane of a terrain, and a note if it may be the wrong one. `surface` has the heights.
    pub fn with_plane(mut self, plane: Option<Plane>, surface: &Mesh) -> Self {
        self.has_heights = plane.is_some() && surface.dimension() == Dimension::Three;
        self.plane = plane.filter(|_| self.has_heights).map(Plane::name);
        if self.has_heights
            && self.inverted > 0
            && let Some(right) = surface.terrain_plane()
        {
            self.notes.push(format!("in the plane {} no triangle is turned over: --plane {0}", right.name()));
        }
        self
    }

    /// Adds what became of points.
    pub fn with_points(mut self, points: Option<Points>) -> Self {
        self.notes.extend(points.as_ref().and_then(Points::note));
        self.points = points;
        self
    }

    /// Adds what became of constraints that cross.
    pub fn with_split(mut self, split: Option<&SplitCrossings>) -> Self {
        if let Some(SplitCrossings { crossings, deviation, left_out, .. }) = split {
            self.new_vertices = crossings.len();
            self.deviation += *deviation;
            self.left_out.clone_from(left_out);
        }
        self
    }

    /// Adds the numbers of joined vertices and of seams.
    pub fn with_joined(mut self, welded: Option<&Welded>) -> Self {
        if let Some(welded) = welded {
            self.joined_vertices = welded.joined();
            self.seam_edges = welded.wedges.locked_edges().len();
        }
        self
    }

    /// Adds notes about the file that was read and about what a file of this format loses, and the edges locked to keep
    /// attributes.
    pub fn with_attributes(mut self, loaded: &Loaded, format: Format, locked: AttributeEdges) -> Self {
        self.attribute_edges = locked.count;
        self.attribute_edges_by_name = locked.by_name;
        self.notes.extend(loaded.notes.iter().cloned());
        if loaded.polygons > 0 {
            let polygons = HumanCount(loaded.polygons as u64);
            let changed = if loaded.keeps(format) { ", where an edge of theirs flips" } else { "" };
            self.notes.push(format!("polygons cut into triangles{changed}: {polygons}"));
        }
        if !loaded.crossing.is_empty() {
            let faces = first(&loaded.crossing);
            self.notes.push(format!(
                "polygons cut into fans although their outline crosses or touches itself, the first face is 0: {faces}"
            ));
        }
        self.crossing_polygons.clone_from(&loaded.crossing);
        if self.coordinates == 64 && !format.has_doubles() {
            let decided =
                "OUT has 32-bit floats: its coordinates are rounded, the result is that of the 64-bit ones";
            self.notes.push(decided.to_owned());
        }
        let dropped = loaded.dropped_in(format);
        if !dropped.is_empty() {
            self.notes.push(format!("not kept: {}", dropped.join("; ")));
        }
        self
    }

    /// Adds a note about the files beside IN that OUT, in another folder, refers to.
    pub fn with_left_behind(mut self, files: &[String]) -> Self {
        if !files.is_empty() {
            let files = first(files);
            self.notes.push(format!("OUT refers to files that are not copied to its folder: {files}"));
        }
        self
    }

    /// Adds notes about the replaced file.
    pub fn add_notes(&mut self, notes: Vec<String>) {
        self.notes.extend(notes);
    }

    /// The notes, one line each.
    pub fn notes(&self) -> String {
        self.notes.iter().fold(String::new(), |text, note| text + "note       " + note + "\n")
    }

    /// The summary: a few aligned lines.
    pub fn summary(&self, args: &Args) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{name:<10} {value}");
        };
        let read = [self.vertices - self.new_vertices, self.triangles - 2 * self.new_vertices];
        let [vertices, triangles] = read.map(|n| HumanCount(n as u64));
        let bits = if self.coordinates == 64 { ", 64-bit coordinates" } else { "" };
        let found = match &self.points {
            Some(points) => points.found(read[0]),
            None => {
                let plane =
                    self.plane.map(|plane| format!(" with heights, plane {plane}")).unwrap_or_default();
                format!("{vertices} vertices, {triangles} triangles, {}D{plane}", self.dimension)
            }
        };
        line("read", format!("{}: {found}{bits}", self.input));
        if let Some(points) = &self.points {
            line("made", points.made());
        }
        let frozen: Vec<String> =
            [(self.non_manifold_edges, "non-manifold"), (self.inconsistent_edges, "inconsistent")]
                .into_iter()
                .filter(|&(count, _)| count > 0)
                .map(|(count, what)| format!("{} {what} edges", HumanCount(count)))
                .collect();
        if !frozen.is_empty() {
            line("frozen", format!("{}, left as they are", frozen.join(", ")));
        }
        if self.attribute_edges > 0 {
            let edges = HumanCount(self.attribute_edges as u64);
            line("locked", format!("{edges} edges stay to keep {}", kept(&self.attribute_edges_by_name)));
        }
        let adapter = self.adapter.as_ref().map(|name| format!(" ({name})")).unwrap_or_default();
        line("backend", format!("{}{adapter}", self.backend));
        if let Some(why) = &self.fallback {
            line("fallback", why.clone());
        }
        if self.device_bytes > 0 {
            let each = self.device_bytes as f64 / self.triangles as f64;
            line(
                "memory",
                format!("{} on the device, {each:.1} bytes per triangle", HumanBytes(self.device_bytes)),
            );
        }
        if self.crossed_edges > 0 {
            let edges = HumanCount(self.crossed_edges);
            line("inserted", format!("constraints, which crossed {edges} edges"));
        }
        if self.deviation > 0.0 && self.new_vertices == 0 {
            line("tolerated", format!("vertices up to {} from constraints", short(self.deviation)));
        }
        if self.new_vertices > 0 {
            let count = HumanCount(self.new_vertices as u64);
            line("split", format!("{count} crossings; an edge moved by up to {}", short(self.deviation)));
        }
        if let Some(LeftOut { reason, .. }) = self.left_out.first() {
            line("left out", format!("constraints: {}; {reason}", HumanCount(self.left_out.len() as u64)));
        }
        if let Some([u, v]) = self.lost_edges.first() {
            let count = HumanCount(self.lost_edges.len() as u64);
            line("lost", format!("locked edges: {count}; the first is {u}-{v}"));
        }
        let iterations = match self.iterations {
            0 => String::new(),
            1 => " in 1 iteration".into(),
            n => format!(" in {} iterations", HumanCount(n.into())),
        };
        line("flips", format!("{}{iterations}, {}", HumanCount(self.flips), self.status));
        line("left", reasons(&self.left));
        if let Some(Check { remaining_edges, .. }) = &self.check
            && !remaining_edges.is_empty()
        {
            line("edges left", first_edges(remaining_edges));
        }
        let [inverted, flat] = match &self.check {
            Some(check) => [&check.inverted_triangles[..], &check.flat_triangles],
            None => [&[][..], &[]],
        };
        for (name, count, what, those) in
            [("inverted", self.inverted, INVERTED, inverted), ("flat", self.flat, FLAT, flat)]
        {
            if count > 0 {
                let those = if those.is_empty() { String::new() } else { format!(" ({})", first(those)) };
                line(name, format!("triangles: {}{those}; {what}", HumanCount(count.into())));
            }
        }
        let Self { before, after, .. } = self;
        line("min angle", format!("{:.3}° → {:.3}°", before.min_angle_deg, after.min_angle_deg));
        line("mean min", format!("{:.3}° → {:.3}°", before.mean_min_angle_deg, after.mean_min_angle_deg));
        line("aspect", format!("{:.3} → {:.3}, the mean", before.mean_aspect, after.mean_aspect));
        let distance =
            self.check.as_ref().map(|check| format!(", the surface by up to {}", short(check.distance)));
        let is_surface = self.dimension == Dimension::Three.stride();
        let distance = distance.filter(|_| is_surface || self.has_heights).unwrap_or_default();
        if self.turned_triangles > 0 {
            line("turned", format!("{} triangles", HumanCount(self.turned_triangles.into())));
        }
        if self.joined_vertices > 0 {
            let seams = match self.seam_edges {
                0 => String::new(),
                n => format!("; edges along seams, locked: {}", HumanCount(n as u64)),
            };
            line("joined", format!("{} vertices{seams}", HumanCount(self.joined_vertices as u64)));
        }
        line("moved", format!("{} triangles{distance}", HumanCount(self.moved_triangles as u64)));
        if is_surface {
            line("area", change(before.area, after.area));
            line("volume", change(before.volume, after.volume));
        }
        if let Some(Check { violations, clean, .. }) = &self.check {
            let found = match violations.len() {
                0 if *clean => "clean".into(),
                0 => "no violations, but not clean: triangles are inverted".into(),
                n => format!("violations: {}", HumanCount(n as u64)),
            };
            line("audit", found);
        }
        // Parts that would be printed as 0.0 are skipped.
        let parts = self.ms.parts().filter(|&(_, ms)| ms >= 0.05);
        let parts: Vec<_> = parts.map(|(name, ms)| format!("{name} {ms:.1}")).collect();
        line("time", format!("{:.1} ms: {}", self.ms.total, parts.join(", ")));
        if self.ms.save.is_some() {
            line("wrote", args.output.display().to_string());
        }
        text
    }
}

/// Pairs as an object with their names.
fn as_object<S: Serializer>(pairs: &[(String, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, count)| (name, count)))
}
