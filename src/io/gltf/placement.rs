//! The placement of meshes by the nodes of the scene.

use super::errors::refuse;
use super::root::Root;
use crate::Error;
use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::json::scene::Node;

/// Relative tolerance for squares of lengths, because quaternions and matrices are rounded to 32 bits.
const ROUNDING: f64 = 1e-5;

/// The placement of a mesh in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// Maps the mesh's coordinates to those of the scene, by the first node that has the mesh.
    pub(super) world: DMat4,
    /// The linear part of `world`, if it changes angles: a non-uniform scale, or a shear.
    pub(super) stretch: Option<DMat3>,
    /// The number of nodes that have the mesh.
    nodes: usize,
    /// Whether all of them keep its angles.
    is_similar_everywhere: bool,
}

impl Placement {
    /// The placement of a mesh that no node has.
    const NOWHERE: Self =
        Self { world: DMat4::IDENTITY, stretch: None, nodes: 0, is_similar_everywhere: true };

    /// Whether two nodes may give the mesh different angles.
    pub(super) fn is_ambiguous(&self) -> bool {
        self.nodes > 1 && !self.is_similar_everywhere
    }

    fn add(&mut self, world: DMat4) {
        let linear = DMat3::from_mat4(world);
        let stretch = (!is_similarity(linear)).then_some(linear);
        self.is_similar_everywhere &= stretch.is_none();
        if self.nodes == 0 {
            (self.world, self.stretch) = (world, stretch);
        }
        self.nodes += 1;
    }
}

/// The placement of each mesh, and the number of nodes that have two parents or are among their own descendants. Such a
/// node counts only where it is reached first.
///
/// # Errors
/// [`Error::Parse`] for a node or a mesh that does not exist.
pub(super) fn placements(root: &Root) -> Result<(Vec<Placement>, usize), Error> {
    let mut loops = 0;
    let mut placements = vec![Placement::NOWHERE; root.meshes.len()];
    let mut is_reached = vec![false; root.nodes.len()];
    let shown = root.scene.as_u64().and_then(|scene| root.scenes.get(usize::try_from(scene).ok()?));
    let roots = shown.into_iter().chain(&root.scenes).flat_map(|scene| &scene.nodes);
    for start in roots.map(|node| node.value()) {
        // A node may be a root of several scenes.
        if is_reached.get(start) == Some(&true) {
            continue;
        }
        let mut pending = vec![(start, DMat4::IDENTITY)];
        while let Some((index, parent)) = pending.pop() {
            let location = || format!("node {index}");
            let Some(node) = root.nodes.get(index) else {
                return Err(refuse(location(), format!("out of range, the file has {}", root.nodes.len())));
            };
            if std::mem::replace(&mut is_reached[index], true) {
                loops += 1;
                continue;
            }
            let world = parent * transform(node);
            if let Some(mesh) = node.mesh {
                let Some(placement) = placements.get_mut(mesh.value()) else {
                    return Err(refuse(location(), format!("there is no mesh {}", mesh.value())));
                };
                // The joints of a skin place its vertices, not the node.
                placement.add(if node.skin.is_some() { DMat4::IDENTITY } else { world });
            }
            pending.extend(node.children.iter().flatten().rev().map(|child| (child.value(), world)));
        }
    }
    Ok((placements, loops))
}

/// Maps the node's coordinates to those of its parent.
fn transform(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vector = |numbers: Option<[f32; 3]>, otherwise| {
        numbers.map_or(otherwise, |numbers| DVec3::from_array(numbers.map(f64::from)))
    };
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    DMat4::from_scale_rotation_translation(
        vector(node.scale, DVec3::ONE),
        if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY },
        vector(node.translation, DVec3::ZERO),
    )
}

/// Whether the matrix keeps angles, or is singular or infinite, so that no angles are left.
fn is_similarity(matrix: DMat3) -> bool {
    let determinant = matrix.determinant();
    if determinant == 0.0 || !determinant.is_finite() {
        return true;
    }
    let squares = matrix.transpose() * matrix;
    let square = (squares.x_axis.x + squares.y_axis.y + squares.z_axis.z) / 3.0;
    (squares - DMat3::from_diagonal(DVec3::splat(square)))
        .to_cols_array()
        .iter()
        .all(|difference| difference.abs() <= ROUNDING * square)
}
