//! The clock rate of a GPU during a run.

use std::{
    io::{BufRead, BufReader},
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicU32, Ordering},
    },
};

/// Reads the clock rate of the first NVIDIA GPU every 10 ms, in a process of its own.
pub struct Clock {
    reader: Option<Child>,
    mhz: Arc<AtomicU32>,
}

impl Clock {
    /// Starts reading. Without an NVIDIA GPU, the rate stays 0.
    pub fn watch() -> Self {
        let mhz = Arc::new(AtomicU32::new(0));
        let query = ["--id=0", "--query-gpu=clocks.sm", "--format=csv,noheader,nounits", "--loop-ms=10"];
        let mut command = Command::new("nvidia-smi");
        let mut reader = command.args(query).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok();
        if let Some(output) = reader.as_mut().and_then(|reader| reader.stdout.take()) {
            let latest = mhz.clone();
            std::thread::spawn(move || {
                for line in BufReader::new(output).lines().map_while(Result::ok) {
                    latest.store(line.trim().parse().unwrap_or(0), Ordering::Relaxed);
                }
            });
        }
        Self { reader, mhz }
    }

    /// The latest rate in MHz; 0 before the first reading.
    pub fn mhz(&self) -> u32 {
        self.mhz.load(Ordering::Relaxed)
    }
}

impl Drop for Clock {
    fn drop(&mut self) {
        if let Some(reader) = &mut self.reader {
            // `kill` fails if the process has already ended.
            let _ = reader.kill();
            let _ = reader.wait();
        }
    }
}
