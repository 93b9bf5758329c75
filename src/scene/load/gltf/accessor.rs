//! Accessors: typed arrays in buffers, checked against the bytes that are there before anything is read.

use super::Failure;
use super::source::Buffers;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Root};

/// Elements of an accessor without a buffer view (all zero but for sparse ones); others are bounded by their buffer.
const ZEROS_MAX: u64 = 1 << 22;

/// Reads accessors of one file.
pub(super) struct Accessors<'a> {
    pub root: &'a Root,
    pub buffers: &'a Buffers<'a>,
}

/// An accessor whose declaration makes sense.
struct Declared<'a> {
    accessor: &'a Accessor,
    place: String,
    component: ComponentType,
    lanes: usize,
    count: usize,
}

impl Declared<'_> {
    fn fail<T>(&self, message: impl Into<String>) -> Result<T, Failure> {
        Err(Failure::new(self.place.clone(), message))
    }

    /// Bytes of an element.
    fn size(&self) -> usize {
        self.component.size() * self.lanes
    }
}

impl Accessors<'_> {
    /// Vectors of `N` floats; integers are converted, to [0, 1] or [-1, 1] where the accessor is normalized.
    /// `user`: what refers to the accessor, for messages. Missing lanes (RGB as RGBA) are `fill`, if it is given.
    pub fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        user: &str,
        fill: Option<f32>,
    ) -> Result<Vec<[f32; N]>, Failure> {
        let declared = self.declared(index, user)?;
        let lanes = declared.lanes;
        if lanes != N && !(lanes == N - 1 && fill.is_some()) {
            return declared.fail(format!("{user} needs {N} numbers each; there are {lanes}"));
        }
        let mut elements = vec![[0.0; N]; if declared.accessor.buffer_view.is_none() { declared.count } else { 0 }];
        if elements.is_empty() {
            elements = Vec::with_capacity(declared.count);
        }
        let convert = |bytes: &[u8]| {
            let mut element = [fill.unwrap_or(0.0); N];
            for (lane, bytes) in element.iter_mut().zip(bytes.chunks_exact(declared.component.size())) {
                *lane = decode_float(declared.component, bytes, declared.accessor.normalized);
            }
            element
        };
        self.each(&declared, |bytes| elements.push(convert(bytes)))?;
        self.each_sparse(&declared, |at, bytes| elements[at] = convert(bytes))?;
        Ok(elements)
    }

    /// Unsigned integers.
    pub fn integers(&self, index: Index<Accessor>, user: &str) -> Result<Vec<u32>, Failure> {
        let declared = self.declared(index, user)?;
        let unsigned = matches!(declared.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if declared.lanes != 1 || !unsigned {
            return declared.fail(format!("{user} needs single unsigned integers"));
        }
        let mut elements = Vec::with_capacity(declared.count);
        if declared.accessor.buffer_view.is_none() {
            elements.resize(declared.count, 0);
        }
        self.each(&declared, |bytes| elements.push(decode_unsigned(bytes)))?;
        self.each_sparse(&declared, |at, bytes| elements[at] = decode_unsigned(bytes))?;
        Ok(elements)
    }

    fn declared(&self, index: Index<Accessor>, user: &str) -> Result<Declared<'_>, Failure> {
        let Some(accessor) = self.root.accessors.get(index.value()) else {
            let message = format!("refers to accessor {index}; there are {}", self.root.accessors.len());
            return Err(Failure::new(user, message));
        };
        let place = format!("accessors[{index}]");
        let (Checked::Valid(component), Checked::Valid(kind)) = (&accessor.component_type, &accessor.type_) else {
            return Err(Failure::new(place, "unknown type or componentType"));
        };
        let lanes = match kind {
            Type::Scalar => 1,
            Type::Vec2 => 2,
            Type::Vec3 => 3,
            Type::Vec4 => 4,
            Type::Mat2 | Type::Mat3 | Type::Mat4 => {
                return Err(Failure::new(place, format!("{user} cannot be a matrix")));
            }
        };
        let mut declared = Declared { accessor, place, component: component.0, lanes, count: 0 };
        let count = accessor.count.0;
        match accessor.buffer_view {
            Some(_) => {
                self.slice(&declared, count)?;
            }
            None if count > ZEROS_MAX => {
                return declared.fail(format!("{count} elements without a bufferView; allowed are {ZEROS_MAX}"));
            }
            None => {}
        }
        declared.count = count as usize;
        Ok(declared)
    }

    /// The bytes from the first element on, and the stride; all `count` elements lie within.
    fn slice(&self, declared: &Declared, count: u64) -> Result<(&[u8], usize), Failure> {
        let Some(view) = declared.accessor.buffer_view else {
            return Ok((&[], 1));
        };
        let (bytes, stride) = self.buffers.view(self.root, view, &declared.place)?;
        let size = declared.size();
        let stride = stride.unwrap_or(size);
        if stride < size {
            return declared.fail(format!("elements of {size} bytes, but a stride of {stride}"));
        }
        let offset = declared.accessor.byte_offset.map_or(0, |offset| offset.0);
        let needed = match count {
            0 => Some(offset),
            _ => (count - 1).checked_mul(stride as u64).and_then(|n| n.checked_add(offset)?.checked_add(size as u64)),
        };
        match needed {
            Some(needed) if needed <= bytes.len() as u64 => Ok((&bytes[offset as usize..], stride)),
            _ => declared.fail(format!(
                "{count} elements from byte {offset} run over the end of bufferView {view}, which has {}",
                bytes.len()
            )),
        }
    }

    fn each(&self, declared: &Declared, mut use_bytes: impl FnMut(&[u8])) -> Result<(), Failure> {
        if declared.accessor.buffer_view.is_none() {
            return Ok(());
        }
        let (bytes, stride) = self.slice(declared, declared.count as u64)?;
        (0..declared.count).for_each(|i| use_bytes(&bytes[i * stride..i * stride + declared.size()]));
        Ok(())
    }

    /// Replacements (glTF 2.0, section 3.6.2.3).
    fn each_sparse(&self, declared: &Declared, mut use_bytes: impl FnMut(usize, &[u8])) -> Result<(), Failure> {
        let Some(sparse) = &declared.accessor.sparse else {
            return Ok(());
        };
        let Checked::Valid(component) = &sparse.indices.component_type else {
            return declared.fail("sparse.indices: unknown componentType");
        };
        let count = sparse.count.0;
        let part = |view, offset: u64, size: usize| {
            let (bytes, _) = self.buffers.view(self.root, view, &declared.place)?;
            let end = count.checked_mul(size as u64).and_then(|n| n.checked_add(offset));
            match end {
                Some(end) if end <= bytes.len() as u64 => Ok(&bytes[offset as usize..end as usize]),
                _ => declared.fail(format!("{count} sparse elements run over the end of bufferView {view}")),
            }
        };
        let index_size = component.0.size();
        let indices = part(sparse.indices.buffer_view, sparse.indices.byte_offset.0, index_size)?;
        let values = part(sparse.values.buffer_view, sparse.values.byte_offset.0, declared.size())?;
        for (index, value) in indices.chunks_exact(index_size).zip(values.chunks_exact(declared.size())) {
            let at = decode_unsigned(index) as usize;
            if at >= declared.count {
                return declared.fail(format!("sparse element {at} of {}", declared.count));
            }
            use_bytes(at, value);
        }
        Ok(())
    }
}

/// One to four bytes, little-endian.
fn decode_unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, byte| value << 8 | u32::from(*byte))
}

/// glTF 2.0, section 3.6.2.2 (normalized integers) and KHR_mesh_quantization (plain ones).
fn decode_float(component: ComponentType, bytes: &[u8], normalized: bool) -> f32 {
    let bits = decode_unsigned(bytes);
    let (value, full_scale) = match component {
        ComponentType::F32 => return f32::from_bits(bits),
        ComponentType::I8 => (f64::from(bits as u8 as i8), 127.0),
        ComponentType::U8 => (f64::from(bits), 255.0),
        ComponentType::I16 => (f64::from(bits as u16 as i16), 32_767.0),
        ComponentType::U16 => (f64::from(bits), 65_535.0),
        ComponentType::U32 => (f64::from(bits), 4_294_967_295.0),
    };
    if normalized { (value / full_scale).max(-1.0) as f32 } else { value as f32 }
}
