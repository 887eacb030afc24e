//! Untangles a mesh in the plane in an update. Fragment programs cannot claim vertices, so the host does the rounds: it
//! waits for the number of triangles that are turned over, and reads the mesh only if there are some.

use super::iteration::{WebGl, in_fours};
use super::moving::UPDATE;
use crate::engine::gpu::upload::leaves_triangle;
use crate::engine::positions_of;
use crate::mesh::areas::Areas;
use crate::mesh::arrangement::Arrangement;
use crate::mesh::star::Fans;
use crate::system::threads::Threads;
use crate::untangle::Frame;
use crate::{Error, NONE};

impl WebGl {
    /// Replaces triangles that have turned over, as far as the rounds of an update do.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn untangle(&mut self) -> Result<(), Error> {
        self.write_params();
        self.count_by(self.areas_program(), 0)?;
        let Areas { inverted, flat, .. } = Areas::of_counts(&self.context.read(&self.history, 1)?);
        if inverted + flat == 0 {
            return Ok(());
        }
        let read = |texture, count: usize, words: usize| -> Result<Vec<u32>, Error> {
            let texels = self.context.read(texture, count)?;
            Ok(texels.chunks_exact(4).take(count).flat_map(|texel| &texel[..words]).copied().collect())
        };
        let vertices = self.params[1] as usize;
        let positions = positions_of(read(&self.positions, vertices, 2)?);
        let mut triangles = read(&self.triangles.front, self.count, 3)?;
        let mut twins = read(&self.twins.front, self.count, 3)?;
        let mut fans = Fans { table: read(&self.fans.front, self.params[4] as usize, 1)? };
        let mut frame = Frame {
            positions: &positions,
            triangles: &mut triangles,
            twins: &mut twins,
            fans: &mut fans,
            winding: &self.winding,
            arrangement: &Arrangement::default(),
            is_left: Some(leaves_triangle),
            written: Vec::new(),
        };
        frame.untangle(vertices, &Threads::one());
        let written = frame.written;
        if written.is_empty() {
            return Ok(());
        }
        self.write_triangles(&triangles)?;
        self.twins.front.write(in_fours(&twins, |_| NONE))?;
        self.fans.front.write(fans.table)?;
        if let Some(changes) = &self.moving.changes {
            let mut words = self.context.read(changes, self.count)?;
            for slot in written {
                words[4 * slot as usize] = self.params[UPDATE];
            }
            changes.write(words)?;
        }
        Ok(())
    }
}
