//! Where the nodes of the scene place a mesh.

use super::errors::refuse;
use super::root::Root;
use crate::Error;
use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::json::scene::Node;

/// Relative to a square of a length: below it two lengths are one. Quaternions and matrices are rounded to 32 bits.
const ROUNDING: f64 = 1e-5;

/// Where a mesh is in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// From the mesh's coordinates to those of the scene, by the first node that has it.
    pub(super) world: DMat4,
    /// What changes the angles of its triangles on the way: a scale that is not uniform, or a shear.
    pub(super) stretch: Option<DMat3>,
    /// How many nodes have it.
    nodes: usize,
    /// Whether all of them leave its angles as they are.
    is_similar_everywhere: bool,
}

impl Placement {
    /// That of a mesh which no node has.
    const NOWHERE: Self =
        Self { world: DMat4::IDENTITY, stretch: None, nodes: 0, is_similar_everywhere: true };

    /// Whether the nodes that have the mesh may disagree about its angles.
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

/// The placement of each mesh, and how many nodes have two parents or are below themselves; such a node counts where it
/// is reached first.
///
/// # Errors
/// [`Error::Parse`] where there is no such node or mesh.
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
            let place = || format!("node {index}");
            let Some(node) = root.nodes.get(index) else {
                return Err(refuse(place(), format!("there are only {} nodes", root.nodes.len())));
            };
            if std::mem::replace(&mut is_reached[index], true) {
                loops += 1;
                continue;
            }
            let world = parent * transform(node);
            if let Some(mesh) = node.mesh {
                let Some(placement) = placements.get_mut(mesh.value()) else {
                    return Err(refuse(place(), format!("there is no mesh {}", mesh.value())));
                };
                // The joints of a skin place its vertices, not the node.
                placement.add(if node.skin.is_some() { DMat4::IDENTITY } else { world });
            }
            pending.extend(node.children.iter().flatten().rev().map(|child| (child.value(), world)));
        }
    }
    Ok((placements, loops))
}

/// From the node's coordinates to those of its parent.
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

/// Whether the matrix leaves angles as they are, or leaves nothing of them to be measured.
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
