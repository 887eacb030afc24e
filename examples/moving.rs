//! A sheet that moves on the GPU, without a window: a compute pass of the program moves the vertices, an update of the
//! session flips the edges, and nothing is read back. With the length of a step, in percent of the spacing, all vertices
//! inside step at random. `cargo run --release --example moving [SIDE] [FRAMES] [PERCENT]`

use edgeflip::{Reason, families};
use pollster::block_on;
use std::{env, error::Error, sync::Arc, time::Instant};

mod motion;
use motion::{Motion, Moving};

fn main() -> Result<(), Box<dyn Error>> {
    let number = |index, default: u32| env::args().nth(index).map_or(Ok(default), |word| word.parse());
    println!("{}", run(number(1, 100)?, number(2, 60)?, number(3, 0)?)?);
    Ok(())
}

/// Moves a sheet of `side` times `side` vertices along waves, or by random steps of up to `percent` of the spacing. Returns
/// a line about it.
pub fn run(side: u32, frames: u32, percent: u32) -> Result<String, Box<dyn Error>> {
    let gpu = motion::open()?;
    let mesh = Arc::new(families::random(side as usize, 2.0, 1)?);
    let motion = match percent {
        0 => Motion::Wave { speed: 0.05, number: 30.0, height: 0.0133 },
        _ => Motion::Walk { step: percent as f32 / (100 * side) as f32 },
    };
    let mut moving = Moving::new(&gpu, &mesh, motion, None)?;
    let start = Instant::now();
    for frame in 0..frames {
        moving.frame(frame, 4, |_| (), |_| ())?;
    }
    moving.wait()?;
    let ms = start.elapsed().as_secs_f64() * 1e3 / f64::from(frames);
    let counters = block_on(moving.session.counters())?;
    Ok(format!(
        "{}: {} triangles, {} flips a frame, {ms:.3} ms a frame, {} edges left to flip, {} triangles turned \
         over",
        gpu.adapter.name,
        mesh.triangle_count(),
        counters.flips / u64::from(frames.max(1)),
        counters.remaining[Reason::Stopped],
        counters.inverted
    ))
}
