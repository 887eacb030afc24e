//! The command line of the benchmarks, and the median.

use std::error::Error;

/// `[--runs N] [FAMILY…]`
pub struct Arguments {
    /// The number of runs of each measurement.
    pub runs: usize,
    /// Specifications of meshes for `edgeflip::families::by_name`.
    pub specs: Vec<String>,
}

impl Arguments {
    /// Reads the command line. `runs` and `specs` are the defaults.
    pub fn read(runs: usize, specs: &[&str]) -> Result<Self, Box<dyn Error>> {
        let mut read = Self { runs, specs: Vec::new() };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            match word.as_str() {
                // `cargo bench` passes this to every benchmark.
                "--bench" => {}
                "--runs" => {
                    let number = words.next().and_then(|n| n.parse().ok()).filter(|&n| n > 0);
                    read.runs = number.ok_or("--runs takes a number from 1")?;
                }
                option if option.starts_with('-') => {
                    return Err(format!("{option} is not known; use [--runs N] [FAMILY…]").into());
                }
                _ => read.specs.push(word),
            }
        }
        if read.specs.is_empty() {
            read.specs = specs.iter().map(ToString::to_string).collect();
        }
        Ok(read)
    }
}

/// The median of `times`; NaN if there are none. For an even number of times, it is the upper one of the two in the
/// middle.
pub fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}
