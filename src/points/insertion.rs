//! Sorts what is nearly sorted.

/// How many times its length a list may be shifted.
const MOST_SHIFTS: usize = 16;

/// Sorts by insertion, in linear time. False if it has given up, because an item is far from its place: then the items
/// are in any order.
pub(super) fn insertion_sorts<T: Copy>(items: &mut [T], is_before: impl Fn(&T, &T) -> bool) -> bool {
    let mut shifts_left = MOST_SHIFTS * items.len();
    for i in 1..items.len() {
        let item = items[i];
        let mut at = i;
        while at > 0 && is_before(&item, &items[at - 1]) {
            items[at] = items[at - 1];
            at -= 1;
        }
        items[at] = item;
        let shifts = i - at;
        if shifts > shifts_left {
            return false;
        }
        shifts_left -= shifts;
    }
    true
}
