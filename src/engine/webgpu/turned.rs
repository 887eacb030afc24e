//! What the host knows of the folds of the last updates.

use super::copies::PendingRead;
use super::device::Device;

/// How many triangles one of the last updates has found turned over. The host is told without a wait, and chooses the
/// dispatches of the rounds by it. Results do not depend on it.
#[derive(Default)]
pub(super) struct Turned {
    pub(super) count: u32,
    /// A read of the count, as long as it is on its way.
    pub(super) read: Option<PendingRead>,
    #[cfg(test)]
    pub(super) rounds: Option<u32>,
}

impl Turned {
    /// Takes in a read that has ended. Returns whether none is on its way.
    pub(super) fn advance(&mut self, gpu: &Device) -> bool {
        let ended = self.read.take().map(|read| read.ended(gpu));
        if let Some(Err(read)) = ended {
            self.read = Some(read);
        } else if let Some(Ok(Some(words))) = ended {
            self.count = words[0];
        }
        self.read.is_none()
    }
}
