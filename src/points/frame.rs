//! The box of a Voronoi diagram. All decisions are those for a box whose sides are a little further in, those of x by
//! infinitely more than those of y: then no circumcentre is on a side and no corner is as near to one point as to
//! another, so the decisions fit each other, and what only touches the box is outside.
//!
//! Sides have numbers, counter-clockwise from the bottom; side k goes from corner k to the next. An outcode has a bit for
//! each side: whether a point is beyond it.

use crate::Error;
use crate::predicates::{Line, compare_circumcentre, crossing, nearer};
use glam::DVec2;
use std::array;

const RIGHT: usize = 1;
const TOP: usize = 2;
const LEFT: usize = 3;

/// A bit for each side.
#[inline(always)]
fn mask([bottom, right, top, left]: [bool; 4]) -> u8 {
    u8::from(bottom) | u8::from(right) << RIGHT | u8::from(top) << TOP | u8::from(left) << LEFT
}

#[derive(Clone, Copy)]
pub(super) struct Frame {
    /// The coordinate of each side.
    sides: [f64; 4],
}

impl Frame {
    /// # Errors
    /// [`Error::Option`].
    pub(super) fn new(bounds: [f64; 4]) -> Result<Self, Error> {
        // Adding 0 turns -0 into 0.
        let [left, bottom, right, top] = bounds.map(|x| x + 0.0);
        if bounds.iter().all(|x| x.is_finite()) && left < right && bottom < top {
            return Ok(Self { sides: [bottom, right, top, left] });
        }
        let message = "give finite [xmin, ymin, xmax, ymax] with xmin < xmax and ymin < ymax".to_owned();
        Err(Error::Option { option: "bounds", message })
    }

    pub(super) fn line(&self, side: usize) -> Line {
        Line { axis: if side == LEFT || side == RIGHT { 0 } else { 1 }, at: self.sides[side] }
    }

    pub(super) fn corner(&self, corner: usize) -> [f64; 2] {
        let [bottom, right, top, left] = self.sides;
        [if corner == 1 || corner == 2 { right } else { left }, if corner < 2 { bottom } else { top }]
    }

    /// The outcode of a circumcentre. A rounded coordinate that is not on a side is on the same side as the exact one.
    #[inline(always)]
    pub(super) fn outcode(&self, centre: DVec2, triangle: [DVec2; 3]) -> u8 {
        let [bottom, right, top, left] = self.sides;
        let is_on = centre.x == left || centre.x == right || centre.y == bottom || centre.y == top;
        if is_on {
            return mask([0, 1, 2, 3].map(|side| {
                let order = compare_circumcentre(triangle, self.line(side));
                if side == RIGHT || side == TOP { order.is_ge() } else { order.is_le() }
            }));
        }
        mask([centre.y < bottom, centre.x > right, centre.y > top, centre.x < left])
    }

    /// Whether a corner is nearer to `p` than to `q`.
    pub(super) fn has_corner(&self, corner: usize, p: DVec2, q: DVec2) -> bool {
        let order = nearer(p, q, self.corner(corner).into());
        if order.is_ne() {
            return order.is_lt();
        }
        // The corner is a little further in.
        let is_right = corner == 1 || corner == 2;
        if p.x == q.x { (q.y < p.y) == (corner < 2) } else { (q.x < p.x) != is_right }
    }

    /// Where the edge between the cells of `p` and `q` is in the box, seen in the direction that has `p` on the left. It
    /// goes from one circumcentre to another, which have these outcodes; `None` is infinitely far.
    pub(super) fn cut(&self, [from, to]: [Option<u8>; 2], [p, q]: [DVec2; 2]) -> Option<Cut> {
        match [from, to] {
            [Some(0), Some(0)] => return Some(Cut { entry: None, exit: None }),
            [Some(from), Some(to)] if from & to != 0 => return None,
            _ => {}
        }
        let is_of_p: [bool; 4] = array::from_fn(|corner| self.has_corner(corner, p, q));
        let side_where =
            |first: bool| (0..4).find(|&side| is_of_p[side] == first && is_of_p[(side + 1) % 4] != first);
        let (entry, exit) = (side_where(true)?, side_where(false)?);
        // The sides into whose half-planes the line goes, in the direction of q - p turned to the left.
        let [right, up] = [p.y > q.y, q.x > p.x];
        let [left, down] = [p.y < q.y, q.x < p.x];
        let (entered, left_behind) = (mask([up, left, down, right]), mask([down, right, up, left]));
        let is_before = from.is_none_or(|from| from & entered != 0);
        let is_after = to.is_none_or(|to| to & left_behind != 0);
        (is_before || from == Some(0)).then_some(())?;
        (is_after || to == Some(0)).then_some(())?;
        Some(Cut { entry: is_before.then_some(entry), exit: is_after.then_some(exit) })
    }

    /// Where the edge between two cells meets a side.
    pub(super) fn crossing(&self, p: DVec2, q: DVec2, side: usize) -> [f64; 2] {
        let line = self.line(side);
        let other = crossing(p, q, line);
        if line.axis == 0 { [line.at, other] } else { [other, line.at] }
    }
}

/// The part of an edge in the box. Without an entry it begins with a circumcentre, without an exit it ends with one.
#[derive(Clone, Copy)]
pub(super) struct Cut {
    pub(super) entry: Option<usize>,
    pub(super) exit: Option<usize>,
}
