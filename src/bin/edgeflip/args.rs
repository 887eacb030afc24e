//! The command line: its options, what they mean, and how they become the library's.

use clap::{Parser, ValueEnum};
use edgeflip::io::{Format, ReadOptions};
use edgeflip::{Backend, Dimension, Options, Order};
use std::num::NonZeroUsize;
use std::path::PathBuf;

const AFTER: &str = "\
Formats, by extension:
  .off   Geomview OFF, text (also COFF, NOFF, STOFF, and nOFF with 2 or 3 dimensions)
  .obj   Wavefront OBJ; all groups and objects are read as one mesh
  .ply   PLY, text or binary; new files are in binary; the only one whose doubles are read as such
  .stl   STL, text or binary, written in binary with 32-bit floats; corners at the same position are
         read as one vertex
  .gltf  glTF 2.0, .glb in one binary file. Each primitive is a part of the mesh; what two of them
         share stays. --weld joins the vertices of a primitive that are at the same position
Any of them may be gzip'd: IN whatever its name, OUT where .gz follows, as in bunny.ply.gz.
Vertices keep their number and order. Polygons are cut into triangles.

Where OUT has the format of IN, it is IN with other triangles: normals, colours, texture coordinates,
groups, materials and comments stay, as does a polygon whose edges stay. So that attributes of faces
and corners stay with them, edges between groups of faces that differ (OBJ: usemtl, g, o, s; OFF, PLY,
STL: what a face has beside its vertices) and along seams never flip, unless --drop-attributes is
given. Otherwise only positions and triangles are written. Text STL, and PLY with strips of triangles,
are written anew.

Exit status:
  0   done; also when stopped by --max-iterations
  1   a file could not be read or written, the mesh was refused, --verify found a violation, or
      memory ran out
  2   wrong usage
  3   the backend asked for is not there, cannot take this mesh, or failed
When a run fails, OUT is not written or changed, and one line on standard error says why. Only what is no
regular file keeps what was written into it before.

Examples:
  edgeflip terrain.off -o terrain-delaunay.off
  edgeflip scan.obj -o scan.obj --max-normal-angle 5 --verify
  edgeflip map.off -o map.off --lock-edges rivers.txt
  edgeflip part.off -o part.obj --backend cpu --json --quiet | jq .flips
  edgeflip scan.ply.gz -o - | ssh host 'cat >scan.ply.gz'";

/// Makes a triangle mesh Delaunay by flipping edges.
///
/// Reads a triangle mesh, in the plane or a surface in space, keeps its vertices, and flips edges until no
/// edge is left that is not Delaunay and may flip. What is left, and why, is reported. Decisions are exact
/// and the result is the same, bit for bit, on every backend.
#[derive(Debug, Parser)]
#[command(name = "edgeflip", version, after_long_help = AFTER)]
#[command(after_help = "--help tells more: formats, exit status, examples.")]
pub struct Args {
    /// The mesh to read: .off, .obj, .ply, .stl, .gltf or .glb, also gzip'd
    ///
    /// A FIFO, here and for the lists below, has to be opened by a writer within 10 s.
    #[arg(value_name = "IN")]
    pub input: PathBuf,

    /// The file to write: .off, .obj, .ply, .stl, .gltf or .glb, and .gz after it to gzip it; may be IN itself. - is
    /// the standard output
    ///
    /// The file is replaced at once when everything is done, so that a failure leaves it as it was. A link is followed;
    /// owner, group and mode stay, or a note says why not. A device or a FIFO is written into, and so is the standard
    /// output under any name. Where it has none of these extensions, it is written in the format of IN, gzip'd if the
    /// name of IN says so. A FIFO has to be opened by a reader within 10 s. --json cannot share the standard output.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,

    /// What does the work
    #[arg(long, value_enum, default_value_t, value_name = "BACKEND")]
    pub backend: BackendArg,

    /// Whether the mesh lies in the plane or in space
    #[arg(long, value_enum, default_value_t, value_name = "DIM")]
    pub dimension: DimensionArg,

    /// How many bytes IN may have, and if it is gzip'd also once it is unpacked
    #[arg(long, value_name = "N", default_value_t = ReadOptions::default().max_bytes, allow_negative_numbers = true)]
    pub max_bytes: u64,

    /// Write positions and triangles only, and let edges flip that keep attributes in their places
    ///
    /// Without it, edges between groups of faces and along seams stay where OUT has the format of IN. It has no effect
    /// on glTF, whose parts share no vertices.
    #[arg(long)]
    pub drop_attributes: bool,

    /// Let a glTF file have its buffers in other files of its folder and of those below
    ///
    /// They are regular files that lie there also when links are followed.
    #[arg(long)]
    pub external_files: bool,

    /// β: largest angle between the normals of two triangles whose edge may flip, in degrees, 0 to 180
    ///
    /// Only for surfaces in space. An edge flips only if the normals of its two triangles differ by at most
    /// β before the flip, and those of the new triangles after it: small values keep the shape, large ones
    /// leave fewer edges that are not Delaunay. An edge over β in the input is a crease and stays. Edges left
    /// for this reason are counted as `angle`.
    #[arg(long, value_name = "DEG", default_value_t = 10.0, value_parser = degrees, allow_negative_numbers = true)]
    pub max_normal_angle: f64,

    /// Largest distance between the old and the new diagonal of a flip, in the units of IN
    ///
    /// Only for surfaces in space: what one flip may move the surface by. It is rounded down to a 32-bit float. Edges
    /// left for this reason are counted as `deviation`.
    #[arg(long, value_name = "D", default_value_t = f64::INFINITY, value_parser = distance, allow_negative_numbers = true)]
    pub max_deviation: f64,

    /// Edges that never flip: a text file with the two vertices of an edge in each line
    ///
    /// Vertices are counted from 0, in the order of IN, also where IN is an OBJ file; # begins a comment. Each
    /// pair has to be an edge of the mesh. Locked edges that are not Delaunay in the end are counted as `locked`.
    #[arg(long, value_name = "FILE")]
    pub lock_edges: Option<PathBuf>,

    /// Triangles that stay as they are: a text file with their numbers
    ///
    /// They are counted from 0, in the order of IN, where a polygon of n corners is n - 2 triangles; # begins a comment.
    /// All edges of these triangles are locked.
    #[arg(long, value_name = "FILE")]
    pub lock_triangles: Option<PathBuf>,

    /// Groups of triangles whose borders stay: a text file with a number for each triangle
    ///
    /// Edges between triangles of different numbers are locked. # begins a comment.
    #[arg(long, value_name = "FILE")]
    pub groups: Option<PathBuf>,

    /// Turn triangles first, so that neighbours agree about the side that is outside
    ///
    /// In each component of triangles that two share an edge, where that is possible, the fewer are turned. Without it
    /// edges between triangles turned against each other stay, and are counted as `inconsistent`.
    #[arg(long)]
    pub reorient: bool,

    /// Join vertices at exactly the same position for the run, and split them again for OUT
    ///
    /// So edges flip where triangles have no vertices in common, as in files that repeat the vertices of each triangle,
    /// and where only the number of a vertex changes. In glTF the vertices of each primitive are joined for
    /// themselves; those that differ in an attribute or a morph target stay two on the two sides of a seam, whose edges
    /// are locked. A primitive without indices gets some where an edge of it flips. Edges of --lock-edges are those
    /// between the positions of two vertices; what is reported of edges is of the joined mesh, which has the first
    /// vertex of each position. Files of other formats than glTF are written as with --drop-attributes.
    #[arg(long)]
    pub weld: bool,

    /// Stop after N iterations; without it the run goes to its end, which always comes
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub max_iterations: Option<u32>,

    /// Which of the valid orders of flips to take
    #[arg(long, value_enum, default_value_t, value_name = "ORDER")]
    pub order: OrderArg,

    /// How many threads --backend cpu runs on, 1 to 256; without it one for each core. Fewer are started where a mesh
    /// has no work for so many: one below 65,536 triangles. As many read, measure and write the mesh. The result is the
    /// same for any number
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub threads: Option<NonZeroUsize>,

    /// Check the result independently; if the check fails, write nothing and end with status 1
    ///
    /// Checks that vertices, boundary, components and orientation are what they were, and that the edges
    /// left are what the run says they are. The summary names the first edges left for each reason by their
    /// two vertices, counted from 0; --json has all of them. Measures, too, how far the surface has moved: the
    /// largest distance between the old and the new one at points of the edges that they do not share.
    #[arg(long)]
    pub verify: bool,

    /// Print one JSON object on standard output instead of the summary
    ///
    /// Keys: input, vertices, triangles, edges, boundary_edges, non_manifold_edges, inconsistent_edges, dimension,
    /// backend, adapter, fallback,
    /// status (done or stopped), iterations, flips, flips_per_iteration, dispatches, device_bytes, remaining (by reason),
    /// min_angle_before_deg, min_angle_after_deg, before and after (min_angle_deg, mean_min_angle_deg, mean_aspect,
    /// flat_triangles, area, volume), turned_triangles, joined_vertices, seam_edges, moved_triangles, attribute_edges
    /// (locked for attributes' sake), ms (milliseconds of wall time, of which all but total add up to it: start; load,
    /// IN read; prepare, lists read, vertices joined, triangles turned, edges locked; device, the GPU waited for, which
    /// is opened while IN is read; upload; adjacency; flip; count, triangles read back and the edges left counted;
    /// measure; verify; save; total, from the start of the program to this object, after which OUT has its name), and
    /// with --verify audit (the violations), remaining_edges (by reason, the two vertices of each edge left, counted
    /// from 0) and distance (between the surfaces before and after).
    #[arg(long)]
    pub json: bool,

    /// No progress, no summary, no notes: only errors, and nothing of a GPU's driver
    #[arg(short, long)]
    pub quiet: bool,
}

impl Args {
    /// Whether anybody sees what is measured.
    pub fn is_reported(&self) -> bool {
        self.json || !self.quiet
    }

    /// How IN is read for an OUT of that format.
    pub fn read_options(&self, output: Format) -> ReadOptions {
        let dimension = match self.dimension {
            DimensionArg::Auto => None,
            DimensionArg::Two => Some(Dimension::Two),
            DimensionArg::Three => Some(Dimension::Three),
        };
        let is_same = Format::of(&self.input).is_ok_and(|input| input == output);
        ReadOptions {
            dimension,
            max_bytes: self.max_bytes,
            external_files: self.external_files,
            keep: is_same && !self.drop_attributes && !self.weld,
        }
    }

    /// What the library is asked to do, without what is locked.
    pub fn options(&self) -> Options {
        Options {
            backend: match self.backend {
                BackendArg::Auto => Backend::Auto,
                BackendArg::Cpu => Backend::Cpu,
                BackendArg::Gpu => Backend::Gpu,
            },
            max_normal_angle: self.max_normal_angle,
            max_deviation: self.max_deviation,
            max_iterations: self.max_iterations,
            threads: self.threads,
            order: match self.order {
                OrderArg::Reproducible => Order::Reproducible,
                OrderArg::Any => Order::Any,
            },
            ..Options::default()
        }
    }
}

/// `--backend`.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum BackendArg {
    /// The GPU where there is one that can take the mesh, else the CPU; the summary says which and why
    #[default]
    Auto,
    /// The CPU; takes every mesh
    Cpu,
    /// The GPU; never falls back (status 3)
    Gpu,
}

/// `--dimension`.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum DimensionArg {
    /// In the plane if every z is 0, else in space; glTF always in space
    #[default]
    Auto,
    /// In the plane; a z other than 0 is refused
    #[value(name = "2")]
    Two,
    /// A surface in space, even if every z is 0
    #[value(name = "3")]
    Three,
}

/// `--order`.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum OrderArg {
    /// The parallel pipeline: the same bits on every backend after every iteration
    #[default]
    Reproducible,
    /// Lawson's sequential algorithm on the CPU: often faster, no iterations to count
    Any,
}

/// A number of threads.
fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let most = edgeflip::MOST_THREADS;
    let count = text.parse().ok().filter(|count: &NonZeroUsize| count.get() <= most);
    count.ok_or_else(|| format!("must be a number from 1 to {most}"))
}

/// A distance from 0 on.
fn distance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(distance) if distance >= 0.0 => Ok(distance),
        Ok(_) => Err("must be 0 or more".into()),
        Err(_) => Err("must be a number".into()),
    }
}

/// An angle from 0 to 180 degrees.
fn degrees(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(angle) if (0.0..=180.0).contains(&angle) => Ok(angle),
        Ok(_) => Err("must be from 0 to 180 degrees".into()),
        Err(_) => Err("must be a number of degrees".into()),
    }
}
