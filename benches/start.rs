//! Measures the time of each engine from the first call of a process to its result: cold, without compiled kernels in
//! the driver's cache, and warm, with them. `cargo bench -p benches --bench start -- [--runs N] [FAMILY…]`.
//!
//! Environment variables switch off the cache of NVIDIA's and Mesa's drivers; another driver may be warm in both
//! columns. `cargo test --release --lib one_by_one -- --nocapture` prints the time of each kernel.

use benches::arguments::{Arguments, median};
use benches::rule::{is_late, verdict};
use edgeflip::{Backend, Options, families, make_delaunay};
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;
use std::{env, error::Error, ops::ControlFlow};

/// If this environment variable is set, the program runs only the job that the variable names. The program starts
/// itself in this way.
const JOB: &str = "EDGEFLIP_START_JOB";

/// The environment variables that switch off the drivers' caches of compiled kernels.
const CACHES: [(&str, &str); 2] = [("__GL_SHADER_DISK_CACHE", "0"), ("MESA_SHADER_CACHE_DISABLE", "true")];

const ENGINES: [(&str, Backend); 3] = [("cpu", Backend::Cpu), ("gpu", Backend::Gpu), ("auto", Backend::Auto)];

fn main() -> Result<(), Box<dyn Error>> {
    if let Ok(job) = env::var(JOB) {
        return one_job(&job);
    }
    let Arguments { runs, specs } = Arguments::read(5, &["random 100", "uvsphere 100"])?;
    println!(
        "Milliseconds from the call to the result, including the driver and the device; medians of {runs} processes."
    );
    println!();
    println!("| mesh | engine | cold | warm | the same again in one process |");
    println!("|---|---|---:|---:|---:|");
    let mut late = Vec::new();
    for spec in &specs {
        let mut best = [f64::INFINITY; 2];
        for (name, backend) in ENGINES {
            let jobs =
                |is_cold| (0..runs).map(|_| in_a_process(name, spec, is_cold)).collect::<Result<Vec<_>, _>>();
            let cold = jobs(true)?;
            // This run fills the caches.
            in_a_process(name, spec, false)?;
            let warm = jobs(false)?;
            let of = |jobs: &[[f64; 2]], which: usize| median(jobs.iter().map(|job| job[which]).collect());
            let times = [of(&cold, 0), of(&warm, 0), of(&warm, 1)];
            println!("| {spec} | {name} | {:.1} | {:.1} | {:.1} |", times[0], times[1], times[2]);
            // The third time is not judged: `auto` may take the CPU again, because no session of its process has
            // prepared the GPU.
            for ((time, best), state) in times.into_iter().zip(&mut best).zip(["cold", "warm"]) {
                if backend != Backend::Auto {
                    *best = best.min(time);
                } else if is_late(time, *best) {
                    late.push(format!("{spec} {state}"));
                }
            }
        }
    }
    println!();
    println!("{}", verdict(&late));
    Ok(())
}

/// The times of the first and the second job of a process.
fn in_a_process(engine: &str, spec: &str, is_cold: bool) -> Result<[f64; 2], Box<dyn Error>> {
    let mut command = Command::new(env::current_exe()?);
    command.env(JOB, format!("{engine} {spec}"));
    if is_cold {
        command.envs(CACHES);
    }
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let text = String::from_utf8(output.stdout)?;
    let times: Vec<f64> = text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    <[f64; 2]>::try_from(times).map_err(|times| format!("two times were expected, not {times:?}").into())
}

fn one_job(job: &str) -> Result<(), Box<dyn Error>> {
    let (name, spec) = job.split_once(' ').ok_or("an engine and a mesh are expected")?;
    let (_, backend) = ENGINES.into_iter().find(|(engine, _)| *engine == name).ok_or("no such engine")?;
    let mesh = Arc::new(families::by_name(spec)?);
    let options = Options { backend, ..Options::default() };
    for _ in 0..2 {
        let start = Instant::now();
        make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(()))?;
        println!("{}", start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(())
}
