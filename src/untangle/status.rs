//! The status of a sweep: a list in an order that only the sweep knows, in blocks, so that no change moves much of it.

/// The most items of a block.
const MOST: usize = 256;

/// A list in blocks, none of which is empty unless it is the only one.
pub(super) struct Status<T> {
    blocks: Vec<Vec<T>>,
}

/// A place in a list: the block, and the index in it.
#[derive(Clone, Copy)]
pub(super) struct Place {
    block: usize,
    index: usize,
}

impl<T> Status<T> {
    pub(super) fn new() -> Self {
        Self { blocks: vec![Vec::new()] }
    }

    /// The place behind all items that are `below`; those are the first ones.
    pub(super) fn find(&self, below: impl Fn(&T) -> bool) -> Place {
        let is_below = |block: &Vec<T>| block.first().is_some_and(&below);
        let block = self.blocks.partition_point(is_below).saturating_sub(1);
        Place { block, index: self.blocks[block].partition_point(below) }
    }

    /// The item before a place that [`Status::find`] has found.
    pub(super) fn before(&self, place: Place) -> Option<&T> {
        self.blocks[place.block].get(place.index.checked_sub(1)?)
    }

    /// The item at a place.
    pub(super) fn at(&self, Place { block, index }: Place) -> Option<&T> {
        self.blocks[block].get(index).or_else(|| self.blocks.get(block + 1)?.first())
    }

    /// Removes the item before a place, which is then that of the item after it.
    pub(super) fn take_before(&mut self, place: &mut Place) -> Option<T> {
        place.index = place.index.checked_sub(1)?;
        self.take(place)
    }

    /// Removes the item at a place.
    pub(super) fn take(&mut self, place: &mut Place) -> Option<T> {
        if place.index == self.blocks[place.block].len() && place.block + 1 < self.blocks.len() {
            *place = Place { block: place.block + 1, index: 0 };
        }
        let block = &mut self.blocks[place.block];
        let item = (place.index < block.len()).then(|| block.remove(place.index));
        if block.is_empty() && self.blocks.len() > 1 {
            self.blocks.remove(place.block);
            if place.block == self.blocks.len() {
                *place = Place { block: place.block - 1, index: self.blocks[place.block - 1].len() };
            }
        }
        item
    }

    /// Inserts items at a place.
    pub(super) fn insert(&mut self, Place { mut block, index }: Place, items: impl IntoIterator<Item = T>) {
        self.blocks[block].splice(index..index, items);
        while self.blocks[block].len() > MOST {
            let rest = self.blocks[block].split_off(MOST / 2);
            block += 1;
            self.blocks.insert(block, rest);
        }
    }
}
