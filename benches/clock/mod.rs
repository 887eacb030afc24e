//! The clock of a GPU, read while something runs.

use std::{
    io::{BufRead, BufReader},
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicU32, Ordering},
    },
};

/// Reads the clock of the first NVIDIA GPU every 10 ms, in a process of its own.
pub struct Clock {
    reader: Option<Child>,
    mhz: Arc<AtomicU32>,
}

impl Clock {
    /// Begins to read; where there is no such GPU, nothing is ever read.
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

    /// In MHz, as it was read last; 0 if it never was.
    pub fn mhz(&self) -> u32 {
        self.mhz.load(Ordering::Relaxed)
    }
}

impl Drop for Clock {
    fn drop(&mut self) {
        if let Some(reader) = &mut self.reader {
            // It may have ended by itself.
            let _ = reader.kill();
            let _ = reader.wait();
        }
    }
}
