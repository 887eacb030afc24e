//! The command-line program: reads a mesh, makes it Delaunay, writes it, and says what happened.

mod args;
mod errors;
mod memory;
mod report;
#[cfg(unix)]
mod signals;

use args::Args;
use clap::Parser;
use edgeflip::io::{self, Output, Staged};
use edgeflip::{Backend, Error, Mesh, Options, Order, Outcome, Welded, make_delaunay, quality, reoriented};
use indicatif::{ProgressBar, ProgressStyle};
use report::{Check, Milliseconds, Report};
use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Why the program ends without a result: the exit status and one line for standard error.
struct Failure {
    status: u8,
    line: String,
}

impl Failure {
    /// What went wrong with `path`; an error that names its path, or is about none, stays as it is.
    fn of(path: &std::path::Path, error: &Error) -> Self {
        let line = match error {
            &Error::FileTooLarge { limit, .. } => {
                let error = Error::FileTooLarge { limit, option: "--max-bytes" };
                format!("{}: {error}", path.display())
            }
            Error::Io { .. }
            | Error::UnknownFormat { .. }
            | Error::Option { .. }
            | Error::BackendUnavailable { .. }
            | Error::Device { .. } => error.to_string(),
            _ => format!("{}: {error}", path.display()),
        };
        let status = match error {
            // Its range has been checked; the system has not so many.
            Error::Option { option: "threads", .. } => 1,
            Error::Option { .. } => 2,
            Error::BackendUnavailable { .. } | Error::BackendLimit { .. } | Error::Device { .. } => 3,
            _ => 1,
        };
        Self { status, line }
    }
}

fn main() -> ExitCode {
    let args = Args::parse();
    if args.quiet {
        errors::only_ours();
    }
    memory::prepare(&one_line(&args.input.display().to_string()));
    #[cfg(unix)]
    signals::watch();
    match run(&args).and_then(|(report, staged)| finish(&args, report, staged)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { status, line }) => {
            errors::say(format!("edgeflip: {}\n", one_line(&line)).as_bytes());
            ExitCode::from(status)
        }
    }
}

fn one_line(text: &str) -> String {
    text.replace(|c: char| c.is_control(), " ")
}

/// A spinner where someone can see it and it does not stand between the lines of the result.
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

/// Everything but the printing. The target is written last, and only if nothing was wrong.
fn run(args: &Args) -> Result<(Report, Option<Staged>), Failure> {
    let refused = |error| Failure::of(&args.input, &error);
    let output = output(args)?;
    let bar = &progress(args, &output);
    bar.set_message(format!("reading {}", args.input.display()));
    let (loaded, load) = timed(|| io::load(&args.input, &args.read_options(output.format())));
    let loaded = loaded.map_err(refused)?;
    let welded = args.weld.then(|| loaded.welded()).transpose().map_err(refused)?;
    let (alone, welded, turned) = turn(args, &loaded.mesh, welded).map_err(refused)?;
    let joined = welded.as_ref().map(|welded| &welded.mesh);
    let mesh = alone.as_ref().or(joined).unwrap_or(&loaded.mesh);

    let mut options = args.options();
    let fallback = without_driver(&mut options, mesh)?;
    options = Options {
        locked_edges: list(&args.lock_edges, io::read_edges)?,
        locked_triangles: list(&args.lock_triangles, io::read_numbers)?,
        groups: list(&args.groups, io::read_numbers)?,
        ..options
    };
    if let Some(welded) = &welded {
        welded.constrain(&mut options);
    }
    let attribute_edges = loaded.constrain(&mut options).map_err(refused)?;

    bar.set_message("preparing");
    let before = quality::measures(mesh);
    let mut outcome = make_delaunay(mesh, &options, |iterations, flips| {
        bar.set_message(format!("iteration {iterations}, {flips} flips"));
        ControlFlow::Continue(())
    })
    .map_err(refused)?;
    outcome.fallback = fallback.or(outcome.fallback);
    let result = mesh.with_triangles(outcome.triangles.clone()).map_err(refused)?;
    let after = quality::measures(&result);
    let moved = quality::moved(mesh.triangles(), result.triangles()).len() as u32;

    let check = args.verify.then(|| {
        bar.set_message("verifying");
        check(&options, mesh, &outcome)
    });
    let (mut staged, mut save) = (None, None);
    if check.as_ref().is_none_or(|check| check.violations.is_empty()) {
        bar.set_message(format!("writing {}", args.output.display()));
        let (written, ms) = timed(|| {
            let triangles = match &welded {
                Some(welded) => welded.split(&outcome.triangles)?,
                None => outcome.triangles.clone(),
            };
            output.stage(&loaded, triangles)
        });
        staged = Some(written.map_err(|e| Failure::of(&args.output, &e))?);
        save = Some(ms);
    }
    bar.finish_and_clear();
    let ms = Milliseconds::new(load, &outcome.timings, save);
    let report = Report::new(args, &result, outcome, [before, after], [turned, moved], check, ms)
        .with_joined(welded.as_ref())
        .with_attributes(&loaded, output.format(), attribute_edges);
    Ok((report, staged))
}

/// Where OUT leads to.
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
            format!("{}: --json has the standard output for itself; give another OUT", args.output.display());
        return Err(Failure { status: 2, line });
    }
    Ok(output)
}

/// Leaves the GPU alone where its driver would end the program for want of memory, and says why.
fn without_driver(options: &mut Options, mesh: &Mesh) -> Result<Option<String>, Failure> {
    let why = match (options.order, options.backend) {
        (Order::Reproducible, Backend::Auto | Backend::Gpu) => {
            memory::too_little_for_a_driver(mesh.triangle_count())
        }
        _ => None,
    };
    match why {
        Some(message) if options.backend == Backend::Gpu => {
            let error = Error::BackendUnavailable { backend: "gpu", message };
            Err(Failure { status: 3, line: error.to_string() })
        }
        why => {
            options.backend = if why.is_some() { Backend::Cpu } else { options.backend };
            Ok(why)
        }
    }
}

/// The list in a file, if there is one.
fn list<'a, T>(
    path: &'a Option<PathBuf>,
    read: impl FnOnce(&'a PathBuf) -> Result<Vec<T>, Error>,
) -> Result<Vec<T>, Failure> {
    let read = |path: &'a PathBuf| read(path).map_err(|error| Failure::of(path, &error));
    path.as_ref().map_or(Ok(Vec::new()), read)
}

/// Turns triangles, if that is asked for, of a mesh that is joined or of one that is not; and how many.
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

/// What the independent check finds: another count of the edges left is a violation too.
fn check(options: &Options, mesh: &Mesh, outcome: &Outcome) -> Check {
    let audit = quality::audit(mesh, &outcome.triangles, options);
    let mut violations: Vec<String> = audit.violations.iter().map(ToString::to_string).collect();
    if audit.remaining != outcome.remaining {
        let [said, counted] = [&outcome.remaining, &audit.remaining].map(report::reasons);
        violations.push(format!("edges left: the run says {said}, the audit counts {counted}"));
    }
    let ends = |reason| audit.remaining_for(reason).collect();
    let remaining_edges = audit.remaining.iter().map(|(reason, _)| (reason.name(), ends(reason))).collect();
    Check { violations, remaining_edges, distance: quality::distance(mesh, &outcome.triangles) }
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed().as_secs_f64() * 1e3)
}

/// Prints the object for `--json`, then gives OUT its name, so that it is as it was if the object cannot be printed. Then
/// the notes and the summary.
fn finish(args: &Args, mut report: Report, staged: Option<Staged>) -> Result<(), Failure> {
    if args.json {
        let printed = print(&report);
        printed.map_err(|error| Failure { status: 1, line: format!("standard output: {error}") })?;
    }
    if let Some(staged) = staged {
        report.add_notes(staged.commit().map_err(|error| Failure::of(&args.output, &error))?);
    }
    if !args.quiet {
        let summary = if args.json { String::new() } else { report.summary(args) };
        errors::say((report.notes() + &summary).as_bytes());
    }
    report.violation().map_or(Ok(()), Err)
}

/// Prints one object on standard output. A reader that has gone away is no failure.
fn print(report: &Report) -> std::io::Result<()> {
    let mut line = serde_json::to_string(report)?;
    line.push('\n');
    let mut out = std::io::stdout().lock();
    match out.write_all(line.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e),
        _ => Ok(()),
    }
}
