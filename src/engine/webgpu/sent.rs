//! Sends the arrays of a page to the device before the mesh is made of them and checked: the browser and the device copy
//! them meanwhile.

use super::buffer::Sent;
use super::buffers::Buffers;
use super::device::Device;
use super::faults::{Caught, watch};
use super::mapped::{Words, groups};
use js_sys::Uint32Array;

impl Device {
    /// Sends as much of the arrays as the mapped staging buffers take: vertex indices, and the words of 32-bit positions.
    /// The session that begins in the same turn of the event loop takes them.
    pub(crate) fn send(&self, indices: &Uint32Array, positions: Option<&Uint32Array>) {
        self.forget_sent();
        let most = self.largest_binding() / 4;
        let mut arrays = [Some(indices), positions].into_iter().flatten();
        if self.kept_for_writes.count() == 0 || arrays.any(|words| u64::from(words.length()) > most) {
            return;
        }
        let begin = || {
            let triangles = Buffers::triangles(self, indices.length() as usize);
            let positions = positions.map(|words| (Buffers::positions(self, words.length() as usize), words));
            let mut writes = vec![(&triangles, 0, Words::Page(indices))];
            writes.extend(positions.iter().map(|(buffer, words)| (buffer, 0, Words::Page(words))));
            let mut written = [0; 2];
            for group in groups(&writes) {
                if !self.stage(&group) {
                    break;
                }
                for ((buffer, ..), range) in &group.0 {
                    written[usize::from(!std::ptr::eq(*buffer, &triangles))] = range.end;
                }
            }
            drop(writes);
            Sent {
                triangles: Some((triangles, written[0])),
                positions: positions.map(|(buffer, _)| (buffer, written[1])),
            }
        };
        let (sent, caught) = watch(&self.device, begin);
        self.sent.replace((sent, vec![caught]));
    }

    /// Drops what no session has taken.
    pub(crate) fn forget_sent(&self) {
        drop(self.take_sent());
    }

    /// What was sent, and the faults.
    pub(super) fn take_sent(&self) -> (Sent, Vec<Caught>) {
        self.sent.take()
    }
}
