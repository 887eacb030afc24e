//! The exact tests. Signs of polynomials in differences of coordinates decide each test. A floating-point filter with a
//! proven bound decides nearly all cases, and exact integers decide the rest. There is no epsilon.
//!
//! An edge (a, b) has the triangles (a, b, c) and (b, a, d). Let p = a - c, q = b - c, r = a - d and s = b - d. The
//! normals are n1 = p × q and n2 = s × r. The numerators of the cosines of the opposite angles are dot1 = p·q and dot2
//! = s·r. After the flip, the triangles (a, d, c) and (b, c, d) have the normals r × p and q × s.

mod bisectors;
mod cosine;
mod crossings;
mod exact;
mod near;
mod plane;
mod rounded;
mod space;

pub(crate) use bisectors::{Line, circumcentre, compare_circumcentre, crossing, nearer};
pub use cosine::cos_degrees;
#[cfg(feature = "gpu")]
pub(crate) use cosine::cosine_fraction;
pub(crate) use crossings::{Segment, distance_from_segment, line_crossing};
pub(crate) use near::{compare_across, compare_along, is_near};
pub(crate) use plane::{area_sign, in_circle_filter, in_circle_sign, total_area_sign};
pub(crate) use space::{Quad, has_area, obtuse};

#[cfg(test)]
mod tests;
#[cfg(test)]
pub(crate) mod tiers;
