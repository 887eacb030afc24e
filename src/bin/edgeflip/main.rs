//! The command-line program: reads a mesh, makes it Delaunay, writes it, and reports the run.

mod args;
mod errors;
mod failure;
mod memory;
mod points;
mod report;
#[cfg(unix)]
mod signals;
mod threads;
mod times;
mod words;

use args::{Args, DimensionArg};
use clap::Parser;
use edgeflip::io::{self, Format, Output, Staged};
use edgeflip::{
    Backend, EarlyGpu, EngineKind, Error, Mesh, Options, Order, Outcome, Plane, Welded, close_gpu,
    make_delaunay, quality, reoriented,
};
use failure::Failure;
use indicatif::{ProgressBar, ProgressStyle};
use points::Points;
use report::{Changes, Check, Report};
use std::io::{IsTerminal, Write};
use std::mem;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use times::Milliseconds;

fn main() {
    let clock = Clock::new();
    let args = Args::parse();
    if args.quiet {
        errors::only_ours();
    }
    memory::prepare(&one_line(&args.input.display().to_string()));
    threads::limit(args.threads);
    #[cfg(unix)]
    signals::watch();
    let status = match run(&args, clock).and_then(|done| finish(&args, done)) {
        Ok(()) => 0,
        Err(Failure { status, line }) => {
            errors::say(format!("edgeflip: {}\n", one_line(&line)).as_bytes());
            status
        }
    };
    memory::end(status)
}

fn one_line(text: &str) -> String {
    text.replace(|c: char| c.is_control(), " ")
}

/// A spinner, if standard error is a terminal and the result does not go to the same terminal.
fn progress(args: &Args, output: &Output) -> ProgressBar {
    let disturbs = (args.json || output.is_standard()) && std::io::stdout().is_terminal();
    if args.quiet || disturbs || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// A run before its report is printed.
struct Done {
    /// `None` if the run is not reported.
    report: Option<Report>,
    /// The failure that `--verify` found.
    violation: Option<Failure>,
    staged: Option<Staged>,
    clock: Clock,
}

/// The whole run except printing. It writes the output last, and only if nothing has failed.
fn run(args: &Args, mut clock: Clock) -> Result<Done, Failure> {
    let refused = |error| Failure::of_run(args, &error);
    if args.plane.is_some() && args.dimension == DimensionArg::Three {
        let line = "option --plane: a terrain is a mesh in the plane; leave out --dimension 3".to_owned();
        return Err(Failure { status: 2, line });
    }
    let output = output(args)?;
    let bar = &progress(args, &output);
    bar.set_message(format!("reading {}", args.input.display()));
    let mut options = args.options();
    let gpu = memory::limit().is_none().then(|| EarlyGpu::open(&options, most_triangles(args)));
    let mut ms = Milliseconds { start: clock.lap(), ..Milliseconds::default() };
    let mut loaded = io::load(&args.input, &args.read_options(output.format())).map_err(refused)?;
    ms.load = clock.lap();
    if args.split_crossings && loaded.keeps(Format::Glb) {
        let line = format!(
            "{}: option --split-crossings: the parts of a glTF file have no place for new vertices; convert it to PLY first",
            args.input.display()
        );
        return Err(Failure { status: 1, line });
    }
    let leaves = loaded.keeps(output.format()) && !output.is_beside(&args.input);
    let left_behind = if leaves { loaded.leave_folder() } else { Vec::new() };
    let has_points = loaded.has_points_only();
    let points = has_points.then(|| loaded.triangulate(args.plane().unwrap_or(Plane::Xy)));
    let points = points.transpose().map_err(refused)?.map(|made| Points::new(made, &loaded));
    let welded = (args.weld && !has_points).then(|| loaded.welded()).transpose().map_err(refused)?;
    let (alone, welded, turned) = turn(args, &loaded.mesh, welded).map_err(refused)?;
    let joined = welded.as_ref().map(|welded| &welded.mesh);
    let surface = alone.as_ref().or(joined).unwrap_or(&loaded.mesh);
    let plane = args.plane().or(has_points.then_some(Plane::Xy));
    let plan = plane.map(|plane| surface.plan(plane)).transpose().map_err(refused)?;
    let mesh = plan.as_ref().unwrap_or(surface);
    let triangles = mesh.triangle_count();
    let mut constraints = list(&args.constraints, triangles, io::read_edges)?;
    points.iter().for_each(|points| points.in_triangles(&mut constraints));
    options = Options {
        locked_edges: list(&args.lock_edges, triangles, io::read_edges)?,
        locked_triangles: list(&args.lock_triangles, triangles, io::read_numbers)?,
        groups: list(&args.groups, triangles, io::read_numbers)?,
        constraints,
        ..options
    };
    if let Some(welded) = &welded {
        welded.constrain(&mut options);
    }
    let attribute_edges = loaded.constrain(&mut options).map_err(refused)?;
    let split = args.split_crossings.then(|| options.split_crossings(mesh)).transpose().map_err(refused)?;
    let lifted = split.as_ref().map(|split| split.lifted(surface, plane.unwrap_or(Plane::Xy)));
    let lifted = lifted.transpose().map_err(refused)?;
    let (mesh, surface) = match (&split, &lifted) {
        (Some(split), Some(lifted)) => (&split.mesh, lifted),
        _ => (mesh, surface),
    };
    ms.prepare = clock.lap();
    // While the GPU is being opened.
    let before = args.is_reported().then(|| quality::measures(mesh));
    ms.measure = before.map(|_| clock.lap());
    let fallback = without_gpu(&mut options, mesh, gpu)?;
    ms.device = clock.lap();

    bar.set_message("preparing");
    let mut outcome = make_delaunay(mesh, &options, |iterations, flips| {
        bar.set_message(format!("iteration {iterations}, {flips} flips"));
        ControlFlow::Continue(())
    })
    .map_err(refused)?;
    close_gpu();
    outcome.fallback = fallback.or(outcome.fallback);
    ms.of_run(&outcome.timings, clock.lap());

    let changes = before.map(|before| Changes::new(mesh, before, &outcome)).transpose().map_err(refused)?;
    ms.measure = ms.measure.map(|before| before + clock.lap());
    let check = args.verify.then(|| {
        bar.set_message("verifying");
        check(&options, mesh, surface, &outcome)
    });
    ms.verify = check.as_ref().map(|_| clock.lap());
    let mut staged = None;
    if check.as_ref().is_none_or(|check| check.violations.is_empty()) {
        bar.set_message(format!("writing {}", args.output.display()));
        let split = welded.as_ref().map(|welded| welded.split(&outcome.triangles));
        let triangles = split.unwrap_or_else(|| Ok(mem::take(&mut outcome.triangles)));
        let written = triangles.and_then(|triangles| match &lifted {
            Some(lifted) => output.stage(&loaded.with_mesh(lifted.clone()), triangles),
            None => output.stage(&loaded, triangles),
        });
        staged = Some(written.map_err(|e| Failure::of(&args.output, &e))?);
        ms.save = Some(clock.lap());
    }
    bar.finish_and_clear();
    let violation = check.as_ref().and_then(|check| check.violation(&args.input));
    let report = changes.map(|changes| {
        Report::new(args, mesh, outcome, changes, turned, check, ms)
            .with_plane(plane, surface)
            .with_points(points)
            .with_split(split.as_ref())
            .with_joined(welded.as_ref())
            .with_attributes(&loaded, output.format(), attribute_edges)
            .with_left_behind(&left_behind)
    });
    Ok(Done { report, violation, staged, clock })
}

/// The fewest bytes of a triangle and half a vertex in most files.
const BYTES_OF_TRIANGLE: u64 = 16;

/// An upper bound on the triangles of IN, from its length; 0 if IN does not exist.
fn most_triangles(args: &Args) -> usize {
    let is_packed = args.input.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    match args.input.metadata() {
        Ok(metadata) if metadata.is_file() && !is_packed => {
            usize::try_from(metadata.len() / BYTES_OF_TRIANGLE).unwrap_or(usize::MAX)
        }
        Ok(_) => usize::MAX,
        Err(_) => 0,
    }
}

/// The output.
fn output(args: &Args) -> Result<Output, Failure> {
    let is_standard = args.output.as_os_str() == "-";
    let output =
        if is_standard { Output::standard(&args.input) } else { Output::of(&args.output, &args.input) };
    let output = output.map_err(|error| {
        let is_of_output =
            matches!(&error, Error::UnknownFormat { path, .. } if *path == args.output.display().to_string());
        Failure { status: if is_of_output { 2 } else { 1 }, line: error.to_string() }
    })?;
    if output.is_standard() && args.json {
        let line =
            format!("{}: --json also writes to the standard output; give another OUT", args.output.display());
        return Err(Failure { status: 2, line });
    }
    Ok(output)
}

/// Changes the backend to the CPU if there is no GPU, or if its driver might end the program for lack of memory.
/// Returns why.
fn without_gpu(options: &mut Options, mesh: &Mesh, gpu: Option<EarlyGpu>) -> Result<Option<String>, Failure> {
    let unavailable = |message| Error::BackendUnavailable { backend: EngineKind::Gpu, message };
    let refusal = match gpu {
        _ if options.order != Order::Reproducible || options.backend == Backend::Cpu => None,
        Some(gpu) => gpu.wait(mesh, options).err().map(|error| (error.to_string(), error)),
        None => memory::too_little_for_a_driver(mesh.triangle_count())
            .map(|message| (message.clone(), unavailable(message))),
    };
    match refusal {
        Some((_, error)) if options.backend == Backend::Gpu => {
            Err(Failure { status: 3, line: error.to_string() })
        }
        Some((why, _)) => {
            options.backend = Backend::Cpu;
            Ok(Some(why))
        }
        None => Ok(None),
    }
}

/// The list in a file, if there is one, for a mesh of so many triangles.
fn list<'a, T>(
    path: &'a Option<PathBuf>,
    triangles: usize,
    read: impl FnOnce(&'a PathBuf, u64) -> Result<Vec<T>, Error>,
) -> Result<Vec<T>, Failure> {
    let Some(path) = path else { return Ok(Vec::new()) };
    // A line with two indices has at most 22 bytes, and a triangle three edges.
    let limit = (1 << 20) + 256 * triangles as u64;
    read(path, limit).map_err(|error| match error {
        Error::FileTooLarge { .. } => {
            let line = format!(
                "{}: the list has more than {limit} bytes, too many for {triangles} triangles; remove repeated lines and comments",
                path.display()
            );
            Failure { status: 1, line }
        }
        error => Failure::of(path, &error),
    })
}

/// With `--reorient`, reverses triangles of the welded mesh, or of the mesh itself. Returns how many.
fn turn(
    args: &Args,
    mesh: &Mesh,
    welded: Option<Welded>,
) -> Result<(Option<Mesh>, Option<Welded>, u32), Error> {
    Ok(match welded {
        _ if !args.reorient => (None, welded, 0),
        Some(welded) => {
            let (welded, turned) = welded.reoriented()?;
            (None, Some(welded), turned)
        }
        None => {
            let (mesh, turned) = reoriented(mesh)?;
            (Some(mesh), None, turned)
        }
    })
}

/// Runs the independent check. `surface` is the mesh with its heights. A different count of the edges left, or of the
/// triangles that are turned over or flat, is also a violation.
fn check(options: &Options, mesh: &Mesh, surface: &Mesh, outcome: &Outcome) -> Check {
    let audit = quality::audit_outcome(mesh, outcome, options);
    let mut violations: Vec<String> = audit.violations.iter().map(ToString::to_string).collect();
    if audit.remaining != outcome.remaining {
        let [said, counted] = [&outcome.remaining, &audit.remaining].map(words::reasons);
        violations.push(format!("edges left: the run says {said}, the audit counts {counted}"));
    }
    let said = [outcome.inverted, outcome.flat].map(|count| count as usize);
    let counted = [audit.inverted.len(), audit.flat.len()];
    if said != counted {
        let [said, counted] =
            [said, counted].map(|[inverted, flat]| format!("inverted {inverted}, flat {flat}"));
        violations.push(format!("triangles: the run says {said}, the audit counts {counted}"));
    }
    let ends = |reason| audit.remaining_for(reason).collect();
    let remaining_edges = audit.remaining.iter().map(|(reason, _)| (reason.name(), ends(reason))).collect();
    Check {
        clean: audit.is_clean() && violations.is_empty(),
        violations,
        remaining_edges,
        inverted_triangles: audit.inverted,
        flat_triangles: audit.flat,
        distance: quality::distance(surface, &outcome.triangles),
    }
}

/// Wall time since the start of the program, with laps.
struct Clock {
    start: Instant,
    last: Instant,
}

impl Clock {
    fn new() -> Self {
        let start = Instant::now();
        Self { start, last: start }
    }

    /// Milliseconds since the last lap.
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        milliseconds(now - mem::replace(&mut self.last, now))
    }

    /// Milliseconds since the start.
    fn total(&self) -> f64 {
        milliseconds(self.start.elapsed())
    }
}

/// Milliseconds, rounded down to microseconds.
fn milliseconds(time: Duration) -> f64 {
    time.as_micros() as f64 / 1e3
}

/// Prints the object of `--json`, then commits OUT, so that OUT stays unchanged if the object cannot be printed. Then
/// prints the notes and the summary.
fn finish(args: &Args, done: Done) -> Result<(), Failure> {
    let Done { mut report, violation, staged, clock } = done;
    if let Some(report) = &mut report {
        report.ms.total = clock.total();
        if args.json {
            let printed = print(report);
            printed.map_err(|error| Failure { status: 1, line: format!("standard output: {error}") })?;
        }
    }
    let notes = staged.map_or(Ok(Vec::new()), Staged::commit);
    let notes = notes.map_err(|error| Failure::of(&args.output, &error))?;
    if let Some(mut report) = report.filter(|_| !args.quiet) {
        report.add_notes(notes);
        let summary = if args.json { String::new() } else { report.summary(args) };
        errors::say((report.notes() + &summary).as_bytes());
    }
    violation.map_or(Ok(()), Err)
}

/// Prints one object on standard output. A closed pipe is not a failure.
fn print(report: &Report) -> std::io::Result<()> {
    let mut line = serde_json::to_string(report)?;
    line.push('\n');
    let mut out = std::io::stdout().lock();
    match out.write_all(line.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e),
        _ => Ok(()),
    }
}
