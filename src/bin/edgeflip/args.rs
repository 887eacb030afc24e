//! The command line: its options, what they mean, and how they become the library's.

use clap::{Parser, ValueEnum};
use edgeflip::io::{Coordinates, Format, ReadOptions};
use edgeflip::{Backend, Dimension, Options, Order, Plane};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

const AFTER: &str = "\
Formats, by extension:
  .off   Geomview OFF, text (also COFF, NOFF, STOFF, and nOFF with 2 or 3 dimensions)
  .obj   Wavefront OBJ; all groups and objects are read as one mesh
  .ply   PLY, text or binary; new files are binary
  .stl   STL, text or binary, written in binary with 32-bit floats; corners at the same position
         are read as one vertex
  .gltf  glTF 2.0, .glb in one binary file. Each primitive is a part of the mesh, and the borders
         between parts stay. --weld joins the vertices of a primitive that are at the same position
  .csv   points: columns x and y, or lon and lat, or easting and northing, and z, height or elevation;
         without names the first two or three columns. Separated by commas, semicolons or tabs
  .xyz   points: two or three numbers in each line
A file of points, also an OFF, OBJ or PLY file without faces, gets the Delaunay triangulation of
its points by x and y, or in the --plane; heights are carried along. Such a file is not written:
OUT is a mesh.
Each format may be gzip'd: IN under any name, OUT if .gz follows the extension, as in bunny.ply.gz.
Vertices keep their number and order. Polygons are cut into triangles.

If OUT has the format of IN, it is IN with other triangles: normals, colours, texture
coordinates, groups, materials and comments stay, and so does a polygon whose edges stay. Faces
and corners keep their attributes: edges between groups of faces that differ (OBJ: usemtl, g, o,
s; OFF, PLY, STL: other attributes of faces) and edges along seams never flip, unless
--ignore-attribute or --drop-attributes is given. If OUT has another format, only positions and
triangles are written. The same holds for text STL, and for PLY with triangle strips.

Exit status:
  0   done; also when stopped by --max-iterations
  1   a file could not be read or written, the mesh or a list was refused, --verify found a
      violation, or memory ran out
  2   wrong usage
  3   the requested backend is not available, cannot take this mesh, or failed
When a run fails, OUT is not written or changed, and one line on standard error says why. Only a
device or a pipe keeps what was written into it before the failure.

Examples:
  edgeflip terrain.off -o terrain-delaunay.off
  edgeflip scan.obj -o scan.obj --max-normal-angle 5 --verify
  edgeflip map.off -o map.off --lock-edges rivers.txt
  edgeflip map.ply -o map.ply --constraints borders.txt
  edgeflip part.off -o part.obj --backend cpu --json --quiet | jq .flips
  edgeflip points.csv -o terrain.ply
  edgeflip terrain.glb -o terrain.glb --plane xz
  edgeflip scan.ply.gz -o - | ssh host 'cat >scan.ply.gz'";

/// Makes a triangle mesh Delaunay by flipping edges.
///
/// Reads a triangle mesh, in the plane or in space, keeps its vertices, and flips edges until every edge is
/// Delaunay or may not flip. The summary counts the edges that are left, by reason. All tests are exact, and
/// the result is the same, bit for bit, on every backend.
#[derive(Debug, Parser)]
#[command(name = "edgeflip", version, after_long_help = AFTER)]
#[command(after_help = "--help shows more: formats, exit status, examples.")]
pub struct Args {
    /// The mesh or the points to read: .off, .obj, .ply, .stl, .gltf, .glb, .csv or .xyz, also gzip'd
    ///
    /// If it is a FIFO, another process has to open it for writing within 10 s. The same holds for the lists below. A
    /// list may have 1 MiB, and 256 bytes for each triangle.
    #[arg(value_name = "IN")]
    pub input: PathBuf,

    /// The file to write: .off, .obj, .ply, .stl, .gltf or .glb, then .gz for gzip; may be IN itself. - is the standard
    /// output
    ///
    /// The file is replaced in one step after everything has succeeded, so a failure leaves it unchanged. Links are
    /// followed. Owner, group and mode stay, or a note says why not. A device, a FIFO or the standard output is written
    /// into; without one of these extensions it gets the format of IN (PLY if that is CSV or XYZ), gzip'd if IN is
    /// named .gz. Another process has to open a FIFO for reading within 10 s. --json cannot share the standard output.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,

    /// The engine
    #[arg(long, value_enum, default_value_t, value_name = "BACKEND")]
    pub backend: BackendArg,

    /// Whether the mesh lies in the plane or in space
    #[arg(long, value_enum, default_value_t, value_name = "DIM")]
    pub dimension: DimensionArg,

    /// The plane of a terrain: these two coordinates decide, and the third, the height, is carried along
    ///
    /// xy for GIS files, where z is up; xz where y is up, as in most files for games and in glTF. The mesh counts as
    /// one in the plane: --constraints and --untangle are allowed, and a normal has no effect. The heights of OUT are
    /// those of IN.
    #[arg(long, value_enum, value_name = "PLANE")]
    pub plane: Option<PlaneArg>,

    /// The bits of the floats that coordinates are read as
    #[arg(long, value_enum, default_value_t, value_name = "BITS")]
    pub coordinates: CoordinatesArg,

    /// The most bytes of IN, packed and unpacked
    #[arg(long, value_name = "N", default_value_t = ReadOptions::default().max_bytes, allow_negative_numbers = true)]
    pub max_bytes: u64,

    /// Write positions and triangles only, and let the edges flip that would stay to keep attributes
    ///
    /// Without it, edges between groups of faces and along seams stay if OUT has the format of IN. It has no effect on
    /// glTF, whose parts share no vertices.
    #[arg(long)]
    pub drop_attributes: bool,

    /// Let edges flip where this attribute of faces or corners differs; may be given several times
    ///
    /// NAME is a property of faces in PLY; vt, vn, usemtl, g, o, s, mg or usemap in OBJ; colour in OFF; attribute in
    /// binary STL. OUT keeps the attribute: a new triangle has that of the triangle that it replaces. If it differs
    /// within that triangle, each corner has that of a corner of a triangle beside it. A name that IN does not have is
    /// an error. The summary and --json name the attributes that lock edges.
    #[arg(long, value_name = "NAME")]
    pub ignore_attribute: Vec<String>,

    /// Read the buffers of a glTF file from other files, in its folder and folders below
    ///
    /// They must be regular files, also after links are followed.
    #[arg(long)]
    pub external_files: bool,

    /// β: largest angle between the normals of two triangles whose edge may flip, in degrees, 0 to 180
    ///
    /// Only in space. An edge flips only if the normals of its two triangles differ by at most β, before and after the
    /// flip. Small values keep the shape; large values leave fewer edges that are not Delaunay. An edge over β in the
    /// input is a crease and stays. The summary counts edges left for this reason as `angle`.
    #[arg(long, value_name = "DEG", default_value_t = 10.0, value_parser = degrees, allow_negative_numbers = true)]
    pub max_normal_angle: f64,

    /// Largest distance between the old and the new diagonal of a flip, in the units of IN
    ///
    /// Only in space. It limits how far one flip moves the surface, and is rounded down to a 32-bit float. The summary
    /// counts edges left for this reason as `deviation`.
    #[arg(long, value_name = "D", default_value_t = f64::INFINITY, value_parser = distance, allow_negative_numbers = true)]
    pub max_deviation: f64,

    /// Edges that never flip: a text file with the two vertices of an edge in each line
    ///
    /// Vertices count from 0, in the order of IN, even if IN is an OBJ file; # begins a comment. Each pair has to be an
    /// edge of the mesh. The summary counts locked edges that are not Delaunay as `locked`.
    #[arg(long, value_name = "FILE")]
    pub lock_edges: Option<PathBuf>,

    /// Triangles that stay: a text file with their indices
    ///
    /// Triangles count from 0, in the order of IN, where a polygon of n corners is n - 2 triangles; # begins a comment.
    /// All edges of these triangles are locked.
    #[arg(long, value_name = "FILE")]
    pub lock_triangles: Option<PathBuf>,

    /// Groups of triangles whose borders stay: a text file with a number for each triangle
    ///
    /// Edges between triangles of different numbers are locked. # begins a comment.
    #[arg(long, value_name = "FILE")]
    pub groups: Option<PathBuf>,

    /// Edges to bring in before the run: a text file with the two vertices of an edge in each line
    ///
    /// Only in the plane, or with --plane. The edges that they cross make way for others; then they are locked. A
    /// vertex on such an edge splits it. Vertices count as for --lock-edges. An edge that crosses another one of the
    /// list, a locked edge or the boundary is an error; see --split-crossings.
    #[arg(long, value_name = "FILE")]
    pub constraints: Option<PathBuf>,

    /// The largest distance of a vertex from an edge of --constraints that counts as on it
    ///
    /// In the units of the coordinates. The edge then goes through the vertex, so that edges meet which miss their
    /// common vertex by rounding. The summary and --json (deviation) give the largest of these distances.
    #[arg(long, value_name = "LENGTH", default_value_t = 0.0, requires = "constraints")]
    pub constraint_tolerance: f64,

    /// Leave out the edges of --constraints that cannot be brought in
    ///
    /// The summary counts them, and --json lists them.
    #[arg(long, requires = "constraints")]
    pub skip_constraints: bool,

    /// Add a vertex where edges of --constraints cross each other
    ///
    /// It is at the crossing, rounded to the floats of the coordinates; with --plane, its height is between those of
    /// the vertices before and after it on the first edge of the list that passes it. The new vertices follow those of
    /// IN. OUT is written as with --drop-attributes. A glTF file is refused: its parts have no place for new vertices.
    #[arg(long, requires = "constraints", conflicts_with = "weld")]
    pub split_crossings: bool,

    /// Make triangles that are turned over or flat positive first, in the plane
    ///
    /// Flips cannot do that: vertices are lifted out of the triangles, and put back where their points are. No vertex
    /// moves, and the boundary stays. Locked edges come back; the summary and --json (lost_edges) name those that
    /// cannot. Other triangles are then at a place of the file than before: what the file says of single triangles does
    /// not move with them. Where the points have no triangulation, some triangles stay as they are.
    #[arg(long)]
    pub untangle: bool,

    /// Reverse triangles first, so that neighbours have the same orientation
    ///
    /// In each component that is orientable, the minority is reversed. Without it, edges between triangles of opposite
    /// orientation stay; the summary counts those that are not Delaunay as `inconsistent`.
    #[arg(long)]
    pub reorient: bool,

    /// Join vertices at exactly the same position for the run, and split them again for OUT
    ///
    /// Then edges flip even if a file repeats the vertices of each triangle, or repeats vertices along lines. In glTF,
    /// only vertices of the same primitive are joined, and edges where their attributes or morph targets differ are
    /// seams, which are locked. A primitive without indices gets indices if one of its edges flips. An edge of
    /// --lock-edges or --constraints is that between the positions of its two vertices. The summary describes the
    /// joined mesh, which has the first vertex at each position. Files of other formats than glTF are written as with
    /// --drop-attributes.
    #[arg(long)]
    pub weld: bool,

    /// Stop after N iterations; without it, the run ends by itself
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub max_iterations: Option<u32>,

    /// The order of the flips; each order gives a valid result
    #[arg(long, value_enum, default_value_t, value_name = "ORDER")]
    pub order: OrderArg,

    /// Threads of the CPU engine and of reading, measuring and writing, 1 to 256; without it one per core. A mesh with
    /// fewer than 65,536 triangles runs on one thread. The result does not depend on the number
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub threads: Option<NonZeroUsize>,

    /// Check the result independently; if the check fails, write nothing and end with status 1
    ///
    /// Checks that vertices, boundary, components and orientation are unchanged, and that the run has counted correctly
    /// the edges left and the triangles that are inverted or flat. The summary names the first edges left for each
    /// reason by their two vertices, and the first of these triangles, all counted from 0; --json lists all. A result
    /// with inverted triangles is not clean, but it is written: no flip could turn them back.
    ///
    /// It also measures how far the surface has moved: the largest distance between the old and the new surface, at
    /// points of the edges that only one of them has.
    #[arg(long)]
    pub verify: bool,

    /// Print one JSON object on standard output instead of the summary
    ///
    /// Keys: input, vertices, triangles, edges, boundary_edges, non_manifold_edges, inconsistent_edges, dimension,
    /// plane (xy, xz or yz; null without --plane), coordinates (32 or 64, the bits of the floats that decide),
    /// crossing_polygons (the numbers of faces, see the notes), points (null for a mesh: heights, whether they have a
    /// third coordinate; hull, the points on it, counter-clockwise; duplicates, each point that equals an earlier one,
    /// and that one), backend, adapter, fallback, status (done or stopped), iterations, flips, crossed_edges (that made
    /// way for constraints), new_vertices (of --split-crossings), deviation (how far an edge of the list is at most
    /// from its way through the result, with --split-crossings or --constraint-tolerance), left_out (for each
    /// constraint left out, its index in the list and the reason), lost_edges (the two vertices of each locked edge
    /// that --untangle could not keep), flips_per_iteration, dispatches, device_bytes, remaining (by reason), inverted
    /// (triangles that are turned over, in the plane: they have not the orientation of the total area of their
    /// component), flat (triangles of no area), min_angle_before_deg, min_angle_after_deg, before and after
    /// (min_angle_deg, mean_min_angle_deg, mean_aspect, flat_triangles, area, volume), turned_triangles (by
    /// --reorient), joined_vertices, seam_edges, moved_triangles, attribute_edges (locked to keep attributes),
    /// attribute_edges_by_name (how many each attribute locks; several may lock the same edge), ms (wall times in
    /// milliseconds, see below), and with --verify audit (the violations), clean (no violation, and no inverted
    /// triangle), remaining_edges (by reason, the two vertices of each edge left, counted from 0), inverted_triangles
    /// and flat_triangles (counted from 0), and distance (between the surfaces before and after).
    ///
    /// The parts of ms add up to its total: start; load (IN is read); prepare (lists are read, vertices joined,
    /// triangles reversed, edges locked); device (the wait for the GPU, which opens while IN is read); constraints
    /// (they come in); upload; adjacency; flip; count (triangles are read back, and the edges left are counted);
    /// measure; verify; save. The total is the time from the start of the program to this object. After that, OUT gets
    /// its name.
    #[arg(long)]
    pub json: bool,

    /// No progress, no summary, no notes, no output of GPU drivers: only errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl Args {
    /// Whether the run reports measures.
    pub fn is_reported(&self) -> bool {
        self.json || !self.quiet
    }

    /// The list in a file that an option of the library is read from.
    pub fn list(&self, option: &str) -> Option<&Path> {
        let list = match option {
            "locked_edges" => &self.lock_edges,
            "locked_triangles" => &self.lock_triangles,
            "groups" => &self.groups,
            "constraints" => &self.constraints,
            _ => &None,
        };
        list.as_deref()
    }

    /// The options for reading IN, if OUT has this format.
    pub fn read_options(&self, output: Format) -> ReadOptions {
        let dimension = match self.dimension {
            DimensionArg::Auto => None,
            DimensionArg::Two => Some(Dimension::Two),
            DimensionArg::Three => Some(Dimension::Three),
        };
        let coordinates = match self.coordinates {
            // OUT shows what decides.
            CoordinatesArg::Auto if !output.has_doubles() => Some(Coordinates::F32),
            CoordinatesArg::Auto => None,
            CoordinatesArg::F32 => Some(Coordinates::F32),
            CoordinatesArg::F64 => Some(Coordinates::F64),
        };
        let is_same = Format::of(&self.input).is_ok_and(|input| input == output);
        ReadOptions {
            dimension,
            plane: self.plane(),
            coordinates,
            max_bytes: self.max_bytes,
            external_files: self.external_files,
            keep: is_same && !self.drop_attributes && !self.weld && !self.split_crossings,
            ignore_attributes: self.ignore_attribute.clone(),
        }
    }

    /// `--plane`.
    pub fn plane(&self) -> Option<Plane> {
        self.plane.map(|plane| match plane {
            PlaneArg::Xy => Plane::Xy,
            PlaneArg::Xz => Plane::Xz,
            PlaneArg::Yz => Plane::Yz,
        })
    }

    /// The options for the library, without locks.
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
            constraint_tolerance: self.constraint_tolerance,
            skips_constraints: self.skip_constraints,
            untangle: self.untangle.then_some(true),
            threads: self.threads,
            order: match self.order {
                OrderArg::Reproducible => Order::Reproducible,
                OrderArg::Any => Order::Any,
            },
            ..Options::default()
        }
    }
}

/// `--coordinates`.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum CoordinatesArg {
    /// 32 if OUT is STL or glTF, which hold no others; else those of a binary file; in text 32, if each float, rounded
    /// to as many digits as its number in IN has, is that number, else 64
    #[default]
    Auto,
    /// 32-bit floats
    #[value(name = "32")]
    F32,
    /// 64-bit floats
    #[value(name = "64")]
    F64,
}

/// `--backend`.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum BackendArg {
    /// The CPU or a hardware GPU, whichever is estimated to finish first; the summary says which and why
    #[default]
    Auto,
    /// The CPU, which takes every mesh
    Cpu,
    /// The GPU, or an error (status 3)
    Gpu,
}

/// `--dimension`.
#[derive(Clone, Copy, Debug, Default, PartialEq, ValueEnum)]
pub enum DimensionArg {
    /// In the plane if every z is 0, or else in space; glTF always in space
    #[default]
    Auto,
    /// In the plane; a z other than 0 is refused without --plane
    #[value(name = "2")]
    Two,
    /// In space, even if every z is 0; --plane is refused
    #[value(name = "3")]
    Three,
}

/// `--plane`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum PlaneArg {
    /// z is up
    Xy,
    /// y is up
    Xz,
    /// x is up
    Yz,
}

/// `--order`.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum OrderArg {
    /// The parallel iterations: the same bits on every backend after every iteration
    #[default]
    Reproducible,
    /// Lawson's algorithm on the CPU: often faster, without iterations
    Any,
}

/// Parses a number of threads.
fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let most = edgeflip::MOST_THREADS;
    let count = text.parse().ok().filter(|count: &NonZeroUsize| count.get() <= most);
    count.ok_or_else(|| format!("must be a number from 1 to {most}"))
}

/// Parses a distance of 0 or more.
fn distance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(distance) if distance >= 0.0 => Ok(distance),
        Ok(_) => Err("must be 0 or more".into()),
        Err(_) => Err("must be a number".into()),
    }
}

/// Parses an angle from 0 to 180 degrees.
fn degrees(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(angle) if (0.0..=180.0).contains(&angle) => Ok(angle),
        Ok(_) => Err("must be from 0 to 180 degrees".into()),
        Err(_) => Err("must be a number of degrees".into()),
    }
}
