//! Reads numbers from buffers, through accessors and buffer views, and checks every bound.

use super::buffers::Buffers;
use super::errors::refuse;
use super::root::Root;
use crate::Error;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::buffer::View;
use gltf::json::validation::Checked;
use std::ops::Range;

/// Extensions that compress the bytes of a buffer view.
const PACKED: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The largest element, a matrix of 4 × 4 numbers of 4 bytes, of an accessor without a buffer view.
const ZEROS: [u8; 64] = [0; 64];

/// Elements of one size in a buffer.
pub(super) struct Elements {
    pub(super) buffer: usize,
    /// From the first byte of the first element to the last byte of the last.
    pub(super) bytes: Range<usize>,
    size: usize,
    /// Bytes from one element to the next.
    pub(super) stride: usize,
    count: usize,
}

impl Elements {
    fn iter<'a>(&self, buffers: &'a Buffers) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        self.these(buffers, 0..self.count)
    }

    /// Some of the elements.
    fn these<'a, I: Iterator<Item = usize>>(
        &self,
        buffers: &'a Buffers<'a>,
        elements: I,
    ) -> impl Iterator<Item = &'a [u8]> + use<'a, I> {
        let (bytes, size, stride) = (&buffers[self.buffer][self.bytes.clone()], self.size, self.stride);
        elements.map(move |i| &bytes[i * stride..i * stride + size])
    }
}

/// The accessors of a file.
pub(super) struct Accessors<'a> {
    pub(super) root: &'a Root,
    pub(super) buffers: &'a Buffers<'a>,
}

impl<'a> Accessors<'a> {
    pub(super) fn get(&self, index: usize) -> Result<&'a Accessor, Error> {
        let accessors = &self.root.accessors;
        let missing =
            || refuse(format!("accessor {index}"), format!("out of range, the file has {}", accessors.len()));
        accessors.get(index).ok_or_else(missing)
    }

    /// Whether the accessor's bytes are compressed.
    pub(super) fn is_packed(&self, index: usize) -> bool {
        let view = self.root.accessors.get(index).and_then(|accessor| accessor.buffer_view);
        let view = view.and_then(|view| self.root.buffer_views.get(view.value()));
        let extensions = view.and_then(|view| view.extensions.as_ref());
        extensions.is_some_and(|extensions| PACKED.iter().any(|name| extensions.others.contains_key(*name)))
    }

    /// The elements of an accessor; `None` if it has no buffer view, and so consists of zeros.
    pub(super) fn elements(&self, index: usize) -> Result<Option<Elements>, Error> {
        let accessor = self.get(index)?;
        let location = || format!("accessor {index}");
        let size = component(accessor, location)?.size() * components(accessor, location)?;
        let Some(view) = accessor.buffer_view else { return Ok(None) };
        let offset = accessor.byte_offset.unwrap_or_default().0;
        self.in_view(view.value(), offset, accessor.count.0, size, location).map(Some)
    }

    fn view(&self, index: usize, location: impl Fn() -> String) -> Result<&'a View, Error> {
        let views = &self.root.buffer_views;
        views.get(index).ok_or_else(|| refuse(location(), format!("there is no buffer view {index}")))
    }

    fn in_view(
        &self,
        index: usize,
        offset: u64,
        count: u64,
        size: usize,
        location: impl Fn() -> String,
    ) -> Result<Elements, Error> {
        let view = self.view(index, &location)?;
        let buffer = view.buffer.value();
        let length = self.buffers.length(buffer, &location)? as u64;
        let stride = view.byte_stride.map_or(0, |stride| stride.0);
        let stride = if stride == 0 { size } else { stride };
        if stride < size {
            return Err(refuse(
                location(),
                format!("elements of {size} bytes lie {stride} bytes apart in buffer view {index}"),
            ));
        }
        // There is no gap after the last element.
        let taken = count.saturating_sub(1).saturating_mul(stride as u64).saturating_add(size as u64);
        let taken = if count == 0 { 0 } else { taken };
        let start = view.byte_offset.unwrap_or_default().0;
        let [in_view, in_buffer] = [offset, start.saturating_add(offset)].map(|at| at.saturating_add(taken));
        for (what, needed, present) in
            [("buffer view", in_view, view.byte_length.0), ("buffer", in_buffer, length)]
        {
            if needed > present {
                let number = if what == "buffer" { buffer } else { index };
                return Err(refuse(
                    location(),
                    format!("it needs {needed} bytes of {what} {number}, which has {present}"),
                ));
            }
        }
        let bytes = (in_buffer - taken) as usize..in_buffer as usize;
        Ok(Elements { buffer, bytes, size, stride, count: count as usize })
    }

    /// The three coordinates of each element. With `elements`, only of these; they must exist, and the accessor must
    /// not be sparse. Integers become floats of the same value. For normalized integers, this only scales the mesh.
    pub(super) fn positions(&self, index: usize, elements: Option<&Vec<u32>>) -> Result<Vec<f32>, Error> {
        let accessor = self.get(index)?;
        let location = || format!("accessor {index}");
        if accessor.type_ != Checked::Valid(Type::Vec3) {
            return Err(refuse(location(), "positions are not of type VEC3"));
        }
        let component = component(accessor, location)?;
        let read = move |element: &[u8]| -> [f32; 3] {
            std::array::from_fn(|axis| number(&element[axis * component.size()..], component))
        };
        let mut positions: Vec<f32> = match (self.elements(index)?, elements) {
            (Some(all), None) => all.iter(self.buffers).flat_map(read).collect(),
            (Some(all), Some(these)) => {
                all.these(self.buffers, these.iter().map(|&i| i as usize)).flat_map(read).collect()
            }
            (None, _) => vec![0.0; 3 * self.count_of_zeros(accessor, location)?],
        };
        for (vertex, value) in self.sparse(accessor, 3 * component.size(), location)? {
            *replaced(positions.as_chunks_mut().0, vertex, location)? = read(value);
        }
        Ok(positions)
    }

    /// The elements that the sparse part of an accessor replaces: their indices, and their `size` bytes.
    fn sparse(
        &self,
        accessor: &Accessor,
        size: usize,
        location: impl Fn() -> String + Copy,
    ) -> Result<impl Iterator<Item = (usize, &'a [u8])>, Error> {
        let parts = accessor.sparse.as_ref().map(|sparse| {
            let (at, values) = (&sparse.indices, &sparse.values);
            let Checked::Valid(kind) = at.component_type else {
                return Err(refuse(location(), "the component type of its sparse indices is not known"));
            };
            let (kind, count) = (kind.0, sparse.count.0);
            let indices =
                self.in_view(at.buffer_view.value(), at.byte_offset.0, count, kind.size(), location)?;
            let values =
                self.in_view(values.buffer_view.value(), values.byte_offset.0, count, size, location)?;
            let indices = indices.iter(self.buffers).map(move |at| integer(at, kind) as usize);
            Ok(indices.zip(values.iter(self.buffers)))
        });
        Ok(parts.transpose()?.into_iter().flatten())
    }

    /// The bytes of some elements, in ascending order.
    ///
    /// # Errors
    /// [`Error::Parse`] if one does not exist, or the accessor is compressed.
    pub(super) fn bytes(&self, index: usize, elements: &[u32]) -> Result<Vec<&'a [u8]>, Error> {
        let accessor = self.get(index)?;
        let location = || format!("accessor {index}");
        let is_there = elements.last().is_none_or(|&last| u64::from(last) < accessor.count.0);
        if !is_there || self.is_packed(index) {
            return Err(refuse(location(), "it does not have all vertices, or is compressed"));
        }
        let size = component(accessor, location)?.size() * components(accessor, location)?;
        let numbers = elements.iter().map(|&element| element as usize);
        let mut bytes: Vec<&[u8]> = match self.elements(index)? {
            Some(all) => all.these(self.buffers, numbers).collect(),
            None => vec![&ZEROS[..size]; elements.len()],
        };
        for (element, value) in self.sparse(accessor, size, location)? {
            if let Ok(rank) = elements.binary_search(&(element as u32)) {
                bytes[rank] = value;
            }
        }
        Ok(bytes)
    }

    /// The number of elements of an accessor without a buffer view. Refuses more elements than the file has bytes.
    fn count_of_zeros(&self, accessor: &Accessor, location: impl Fn() -> String) -> Result<usize, Error> {
        let count = accessor.count.0;
        if accessor.sparse.is_some() && count <= self.buffers.total() {
            return Ok(count as usize);
        }
        Err(refuse(location(), format!("it announces {count} elements and has no data for them")))
    }

    /// Whether the numbers fit an accessor of indices. The largest number of its type is reserved: it restarts a strip.
    pub(super) fn can_hold(&self, index: usize, numbers: &[u32]) -> Result<bool, Error> {
        let largest = match component(self.get(index)?, || format!("accessor {index}"))? {
            ComponentType::U8 => u32::from(u8::MAX),
            ComponentType::U16 => u32::from(u16::MAX),
            _ => u32::MAX,
        };
        Ok(numbers.iter().all(|&number| number < largest))
    }

    /// The indices in an accessor.
    pub(super) fn indices(&self, index: usize) -> Result<Vec<u32>, Error> {
        let accessor = self.get(index)?;
        let location = || format!("accessor {index}");
        let component = component(accessor, location)?;
        if accessor.type_ != Checked::Valid(Type::Scalar) || !is_unsigned(component) {
            return Err(refuse(location(), "indices are not unsigned integers of type SCALAR"));
        }
        let mut indices: Vec<u32> = match self.elements(index)? {
            Some(elements) => {
                elements.iter(self.buffers).map(|element| integer(element, component)).collect()
            }
            None => vec![0; self.count_of_zeros(accessor, location)?],
        };
        for (corner, value) in self.sparse(accessor, component.size(), location)? {
            *replaced(&mut indices, corner, location)? = integer(value, component);
        }
        Ok(indices)
    }
}

/// The element that a sparse part replaces.
fn replaced<T>(elements: &mut [T], index: usize, location: impl Fn() -> String) -> Result<&mut T, Error> {
    let missing = || refuse(location(), format!("it has no element {index}, which its sparse part changes"));
    elements.get_mut(index).ok_or_else(missing)
}

pub(super) fn component(accessor: &Accessor, location: impl Fn() -> String) -> Result<ComponentType, Error> {
    match accessor.component_type {
        Checked::Valid(component) => Ok(component.0),
        Checked::Invalid => Err(refuse(location(), "its component type is not known")),
    }
}

fn components(accessor: &Accessor, location: impl Fn() -> String) -> Result<usize, Error> {
    match accessor.type_ {
        Checked::Valid(kind) => Ok(kind.multiplicity()),
        Checked::Invalid => Err(refuse(location(), "its type is not known")),
    }
}

fn is_unsigned(component: ComponentType) -> bool {
    matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
}

/// The component at the start of `bytes`, which must be long enough.
fn number(bytes: &[u8], component: ComponentType) -> f32 {
    let word = || bytes.first_chunk().copied().unwrap_or_default();
    match component {
        ComponentType::I8 => f32::from(bytes[0] as i8),
        ComponentType::I16 => f32::from(i16::from_le_bytes([bytes[0], bytes[1]])),
        ComponentType::U8 | ComponentType::U16 => integer(bytes, component) as f32,
        ComponentType::U32 => u32::from_le_bytes(word()) as f32,
        ComponentType::F32 => f32::from_le_bytes(word()),
    }
}

/// The unsigned integer at the start of `bytes`, which must be long enough.
fn integer(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 => u32::from(bytes[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        _ => u32::from_le_bytes(bytes.first_chunk().copied().unwrap_or_default()),
    }
}
