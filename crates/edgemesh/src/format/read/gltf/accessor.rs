//! Accessors: typed elements in the bytes of a buffer.
//!
//! Based on: glTF 2.0, sections 3.6.1 and 3.6.2 (buffer views, accessors,
//! sparse accessors).
//!
//! ```text
//! buffer    |.....................................................|
//! view           |<- byteOffset      byteLength                ->|
//! accessor            |<- byteOffset  [xyz]..[xyz]..[xyz]|
//!                                     |stride|             the last may be shorter
//! ```
//!
//! All ranges are checked in 64 bits before a byte is read. Numbers become 32-bit
//! floats, which hold all component types exactly except 32-bit integers; those occur
//! only in indices.

use gltf_json as json;
use json::accessor::Type;
use json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::asset::Asset;
use super::buffer::slice;
use super::component::Component;
use super::meshopt::decode;
use crate::report::Place;

/// An accessor without a view consists of zeros, which take no bytes of the file: at
/// most this many elements beyond one for each byte.
pub(super) const MAX_FREE_ZEROS: u64 = 1 << 16;

/// An accessor with checked ranges.
#[derive(Debug)]
pub(super) struct Accessor<'a> {
    source: &'a Source<'a>,
    index: usize,
    count: usize,
    component: Component,
    kind: Type,
    is_normalized: bool,
    /// `None` for zeros.
    elements: Option<Elements<'a>>,
    sparse: Option<Sparse<'a>>,
}

/// Elements at equal distances.
#[derive(Debug)]
struct Elements<'a> {
    /// From the first byte of the first element to the last byte of the last.
    bytes: &'a [u8],
    /// The distance between elements, in bytes; not 0.
    stride: usize,
}

/// Elements that replace others (sparse accessors).
#[derive(Debug)]
struct Sparse<'a> {
    /// The indices of the replaced elements, all in range.
    indices: Vec<[u32; 1]>,
    values: Elements<'a>,
}

/// The stated place of elements.
struct ElementLayout {
    /// The index of the view.
    view: usize,
    offset: u64,
    count: u64,
    /// Bytes of an element.
    size: u64,
}

impl Asset<'_> {
    /// The accessor with this index, which `part` refers to.
    ///
    /// # Errors
    /// `Bounds` if its elements leave their view or buffer, `Syntax` if it is malformed
    /// or does not exist, and the errors of its buffer.
    pub(super) fn accessor(
        &self,
        index: usize,
        part: impl FnOnce() -> String,
    ) -> Result<Accessor<'_>, ReadError> {
        let json = self.get(&self.document.accessors, index, "accessors", part)?;
        let part = || format!("accessors[{index}]");
        let (Some(component), Checked::Valid(kind)) =
            (Component::of_number(json.component_type), &json.type_)
        else {
            let what = "has a type or component type that glTF does not define";
            return Err(self.error(ReadErrorKind::Syntax, part(), what));
        };
        let size = (component.size() * kind.multiplicity()) as u64;
        let elements = match json.buffer_view {
            Some(view) => {
                let offset = json.byte_offset.unwrap_or_default().0;
                let layout =
                    ElementLayout { view: view.value(), offset, count: json.count.0, size };
                Some(self.elements(&layout, &part)?)
            }
            None => self.check_zeros(json.count.0, &part).map(|()| None)?,
        };
        // Bounded by the size of the file or the limit for zeros.
        let count = usize::try_from(json.count.0).unwrap_or(usize::MAX);
        self.spend(count, part)?;
        let sparse = json.sparse.as_ref().map(|sparse| self.sparse(sparse, count, size, &part));
        Ok(Accessor {
            source: self.source,
            index,
            count,
            component,
            kind: *kind,
            is_normalized: json.normalized,
            elements,
            sparse: sparse.transpose()?,
        })
    }

    fn check_zeros(&self, count: u64, part: &dyn Fn() -> String) -> Result<(), ReadError> {
        if count <= MAX_FREE_ZEROS + self.budget.bytes() as u64 {
            return Ok(());
        }
        let what = format!("has {count} elements and no buffer view");
        Err(self.error(ReadErrorKind::Bounds, part(), what))
    }

    /// The elements that replace some of `count` elements of `size` bytes each.
    fn sparse(
        &self,
        json: &json::accessor::sparse::Sparse,
        count: usize,
        size: u64,
        part: &dyn Fn() -> String,
    ) -> Result<Sparse<'_>, ReadError> {
        let json::accessor::sparse::Sparse { count: replaced, indices, values, .. } = json;
        let component = match &indices.component_type {
            Checked::Valid(component) => Component::of_number(component.0.as_gl_enum()),
            Checked::Invalid => None,
        };
        let Some(component) = component else {
            let what = "has sparse indices with a component type that is not allowed";
            return Err(self.error(ReadErrorKind::Syntax, part(), what));
        };
        let at = |view: usize, offset, size| {
            self.elements(&ElementLayout { view, offset, count: replaced.0, size }, part)
        };
        let index_size = component.size() as u64;
        let found = at(indices.buffer_view.value(), indices.byte_offset.0, index_size)?;
        let values = at(values.buffer_view.value(), values.byte_offset.0, size)?;
        let indices: Vec<[u32; 1]> = found.unsigned(component);
        self.spend(indices.len(), part)?;
        match indices.iter().find(|[index]| *index as usize >= count) {
            Some([index]) => {
                let what = format!("replaces element {index} of {count}");
                Err(self.error(ReadErrorKind::Bounds, part(), what))
            }
            None => Ok(Sparse { indices, values }),
        }
    }

    /// The bytes of the view with this index, which `part` refers to.
    ///
    /// # Errors
    /// `Bounds` if it leaves its buffer, `Syntax` if it does not exist, and the errors
    /// of its buffer.
    pub(super) fn view(&self, index: usize, part: &dyn Fn() -> String) -> Result<&[u8], ReadError> {
        let view = self.get(&self.document.buffer_views, index, "bufferViews", part)?;
        if let Some(decoded) = self.decoded_view(index, view)? {
            return Ok(decoded);
        }
        let view_part = || format!("bufferViews[{index}]");
        let buffer = self.buffer(view.buffer.value(), view_part)?;
        let start = view.byte_offset.unwrap_or_default().0;
        let length = view.byte_length.0;
        slice(buffer, start, length).ok_or_else(|| {
            let what =
                format!("needs {length} bytes from byte {start} of a buffer with {}", buffer.len());
            self.error(ReadErrorKind::Bounds, view_part(), what)
        })
    }

    /// The bytes of a compressed view; `None` if it is not compressed.
    fn decoded_view(
        &self,
        index: usize,
        view: &json::buffer::View,
    ) -> Result<Option<&[u8]>, ReadError> {
        let Some(cell) = self.decoded_views.get(index) else { return Ok(None) };
        let decoded = cell.get_or_init(|| decode(self, index, view));
        decoded.as_ref().map(Option::as_deref).map_err(Clone::clone)
    }

    /// The bytes of elements; `part` is their accessor.
    fn elements(
        &self,
        layout: &ElementLayout,
        part: &dyn Fn() -> String,
    ) -> Result<Elements<'_>, ReadError> {
        let ElementLayout { view: index, offset, count, size } = *layout;
        let view = self.get(&self.document.buffer_views, index, "bufferViews", part)?;
        let stride = view.byte_stride.map_or(0, |stride| stride.0 as u64);
        let stride = if stride == 0 { size } else { stride };
        if stride < size {
            let what = format!("has elements of {size} bytes at a stride of {stride}");
            return Err(self.error(ReadErrorKind::Syntax, part(), what));
        }
        let in_view = self.view(index, part)?;
        let length = in_view.len();
        let needed = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size)),
        };
        let bytes = needed.and_then(|needed| slice(in_view, offset, needed)).ok_or_else(|| {
            let what = format!(
                "has {count} elements of {size} bytes at a stride of {stride}, from byte \
                 {offset} of bufferViews[{index}], which has {length}; the file is truncated or \
                 damaged"
            );
            self.error(ReadErrorKind::Bounds, part(), what)
        })?;
        // The stride of existing elements is at most the length of a view.
        Ok(Elements { bytes, stride: usize::try_from(stride).unwrap_or(usize::MAX) })
    }
}

impl Accessor<'_> {
    /// Its index in the file.
    pub(super) const fn index(&self) -> usize {
        self.index
    }

    /// The number of elements.
    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// The type of its elements.
    pub(super) const fn kind(&self) -> Type {
        self.kind
    }

    /// The type of its components.
    pub(super) const fn component(&self) -> Component {
        self.component
    }

    /// Whether its numbers are those of the file, not normalized.
    pub(super) const fn is_raw(&self) -> bool {
        matches!(self.component, Component::F32) || !self.is_normalized
    }

    /// Normalizes integers to 0 to 1 or -1 to 1, even if the file does not ask for it.
    pub(super) const fn normalized(mut self) -> Self {
        self.is_normalized = true;
        self
    }

    /// Its elements as numbers.
    ///
    /// # Errors
    /// `Syntax` if they do not have `N` components.
    pub(super) fn numbers<const N: usize>(&self) -> Result<Vec<[f32; N]>, ReadError> {
        self.check_components(N)?;
        if self.component == Component::I32 {
            return Err(self.wrong("has signed 32-bit integers, which glTF does not define"));
        }
        Ok(self.collect(|elements| elements.numbers(self.component, self.is_normalized)))
    }

    /// Its elements as unsigned integers.
    ///
    /// # Errors
    /// `Syntax` if they do not have `N` components, or are of another type.
    pub(super) fn unsigned<const N: usize>(&self) -> Result<Vec<[u32; N]>, ReadError> {
        self.check_components(N)?;
        match self.component {
            Component::U8 | Component::U16 | Component::U32 => {
                Ok(self.collect(|elements| elements.unsigned(self.component)))
            }
            _ => Err(self.wrong("must have unsigned integers")),
        }
    }

    /// Its elements as indices. glTF requires unsigned integers; those of other programs may be
    /// of a signed type, which is as good if none is negative.
    ///
    /// # Errors
    /// `Syntax` if they are not single integers, or one is negative.
    pub(super) fn indices(&self) -> Result<Vec<u32>, ReadError> {
        if !self.component.is_signed_integer() {
            return self.unsigned::<1>().map(Vec::into_flattened);
        }
        self.check_components(1)?;
        let signed = self.collect(|elements| elements.signed(self.component));
        let indices = signed.iter().enumerate().map(|(at, &[index])| {
            u32::try_from(index).map_err(|_| self.wrong(format!("has the index {index} at {at}")))
        });
        indices.collect()
    }

    fn check_components(&self, count: usize) -> Result<(), ReadError> {
        match self.kind.multiplicity() {
            found if found == count => Ok(()),
            found => Err(self.wrong(format!("has elements of {found} numbers instead of {count}"))),
        }
    }

    fn wrong(&self, what: impl Into<String>) -> ReadError {
        let place = Place::Part(format!("accessors[{}]", self.index));
        self.source.error(ReadErrorKind::Syntax, Some(place), what)
    }

    /// Reads elements with `read`, then those that replace some of them.
    fn collect<T: Copy + Default, const N: usize>(
        &self,
        read: impl Fn(&Elements) -> Vec<[T; N]>,
    ) -> Vec<[T; N]> {
        let mut found = match &self.elements {
            Some(elements) => read(elements),
            None => vec![[T::default(); N]; self.count],
        };
        if let Some(sparse) = &self.sparse {
            for ([index], value) in sparse.indices.iter().zip(read(&sparse.values)) {
                if let Some(element) = found.get_mut(*index as usize) {
                    *element = value;
                }
            }
        }
        found
    }
}

impl Elements<'_> {
    /// Empty for signed 32-bit integers.
    fn numbers<const N: usize>(&self, component: Component, is_normalized: bool) -> Vec<[f32; N]> {
        let scaled = |number: f32, largest: f32| match is_normalized {
            // The least signed integer would be a little below -1.
            true => (number / largest).max(-1.0),
            false => number,
        };
        match component {
            Component::I8 => self.map(|bytes| scaled(f32::from(i8::from_le_bytes(bytes)), 127.0)),
            Component::U8 => self.map(|[byte]| scaled(f32::from(byte), 255.0)),
            Component::I16 => {
                self.map(|bytes| scaled(f32::from(i16::from_le_bytes(bytes)), 32_767.0))
            }
            Component::U16 => {
                self.map(|bytes| scaled(f32::from(u16::from_le_bytes(bytes)), 65_535.0))
            }
            Component::U32 => self.map(|bytes| u32::from_le_bytes(bytes) as f32),
            Component::I32 => Vec::new(),
            Component::F32 => self.map(f32::from_le_bytes),
        }
    }

    /// Empty for other component types.
    fn unsigned<const N: usize>(&self, component: Component) -> Vec<[u32; N]> {
        match component {
            Component::U8 => self.map(|[byte]| byte.into()),
            Component::U16 => self.map(|bytes| u16::from_le_bytes(bytes).into()),
            Component::U32 => self.map(u32::from_le_bytes),
            _ => Vec::new(),
        }
    }

    /// Empty for other component types.
    fn signed<const N: usize>(&self, component: Component) -> Vec<[i32; N]> {
        match component {
            Component::I8 => self.map(|bytes| i8::from_le_bytes(bytes).into()),
            Component::I16 => self.map(|bytes| i16::from_le_bytes(bytes).into()),
            Component::I32 => self.map(i32::from_le_bytes),
            _ => Vec::new(),
        }
    }

    /// Reads each element as `N` components of `SIZE` bytes.
    fn map<T: Default, const N: usize, const SIZE: usize>(
        &self,
        convert: impl Fn([u8; SIZE]) -> T,
    ) -> Vec<[T; N]> {
        let read = |element: &[u8]| {
            let components = element.as_chunks::<SIZE>().0;
            std::array::from_fn(|at| {
                components.get(at).map_or_else(T::default, |&bytes| convert(bytes))
            })
        };
        self.bytes.chunks(self.stride).map(read).collect()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::document::Document;
    use super::super::sample::Sample;
    use super::*;

    /// What `look` returns for the last accessor of `sample`.
    fn with<T>(
        sample: &Sample,
        look: impl FnOnce(Accessor) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        let document: Document = serde_json::from_value(sample.json(&json!({}))).unwrap();
        let source = Source { name: "test.gltf", folder: None, bytes: b"" };
        let asset = Asset::new(&source, &document, None);
        look(asset.accessor(document.accessors.len() - 1, String::new)?)
    }

    fn numbers<const N: usize>(sample: &Sample) -> Result<Vec<[f32; N]>, ReadError> {
        with(sample, |accessor| accessor.numbers())
    }

    /// A file with one accessor of these members, in a view of `bytes`.
    fn sample(bytes: &[u8], view: &Value, accessor: Value) -> Sample {
        let mut sample = Sample::default();
        sample.view(bytes, view);
        let mut json = accessor;
        json["bufferView"] = 0.into();
        sample.accessor(json);
        sample
    }

    #[test]
    fn each_type_of_component() {
        let read = |component: u32, bytes: &[u8], is_normalized: bool| {
            let accessor = json!({
                "componentType": component, "count": 2, "type": "SCALAR",
                "normalized": is_normalized
            });
            let [[a], [b]] = numbers(&sample(bytes, &json!({}), accessor)).unwrap()[..] else {
                panic!("not two elements of {component}")
            };
            [a, b]
        };
        assert_eq!(read(5120, &[3, 0x80], false), [3.0, -128.0]);
        assert_eq!(read(5120, &[127, 0x80], true), [1.0, -1.0]);
        assert_eq!(read(5121, &[3, 255], false), [3.0, 255.0]);
        assert_eq!(read(5121, &[0, 255], true), [0.0, 1.0]);
        assert_eq!(read(5122, &[2, 1, 0xff, 0xff], false), [258.0, -1.0]);
        assert_eq!(read(5122, &[0xff, 0x7f, 0, 0x80], true), [1.0, -1.0]);
        assert_eq!(read(5123, &[2, 1, 0xff, 0xff], false), [258.0, 65535.0]);
        assert_eq!(read(5123, &[0, 0, 0xff, 0xff], true), [0.0, 1.0]);
        assert_eq!(read(5125, &[1, 0, 0, 0, 0, 1, 0, 0], false), [1.0, 256.0]);
        assert_eq!(read(5126, &[0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0], false), [1.0, -2.0]);
    }

    #[test]
    fn elements_may_have_a_stride() {
        let bytes = [9, 1, 2, 9, 3, 4, 9, 5, 6];
        let accessor = json!({"byteOffset": 1, "componentType": 5121, "count": 3, "type": "VEC2"});
        let found = numbers(&sample(&bytes, &json!({"byteStride": 3}), accessor.clone())).unwrap();
        assert_eq!(found, [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]);
        let error = numbers::<2>(&sample(&bytes, &json!({"byteStride": 1}), accessor)).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Syntax);
    }

    #[test]
    fn ranges_are_checked_in_64_bits() {
        let refusal = |view: Value, accessor: Value| {
            let error = numbers::<3>(&sample(&[0; 36], &view, accessor)).unwrap_err();
            assert_eq!(error.kind, ReadErrorKind::Bounds, "{error}");
            error.place
        };
        let three = |count: u64, offset: u64| json!({"byteOffset": offset, "componentType": 5126, "count": count, "type": "VEC3"});
        let [view, accessor] = ["bufferViews[0]", "accessors[0]"];
        let [view, accessor] = [view, accessor].map(|part| Some(Place::Part(part.into())));
        assert!(numbers::<3>(&sample(&[0; 36], &json!({}), three(3, 0))).is_ok());
        assert_eq!(refusal(json!({}), three(4, 0)), accessor);
        assert_eq!(refusal(json!({}), three(3, 1)), accessor);
        assert_eq!(refusal(json!({}), three(1 << 62, 0)), accessor);
        assert_eq!(refusal(json!({}), three(u64::MAX, 0)), accessor);
        assert_eq!(refusal(json!({}), three(1, u64::MAX)), accessor);
        assert_eq!(refusal(json!({"byteOffset": 4_294_967_290_u64}), three(3, 0)), view);
        assert_eq!(refusal(json!({"byteOffset": u64::MAX}), three(3, 0)), view);
    }

    #[test]
    fn sparse_elements_replace_others() {
        let with_base = |base: Option<usize>, replaced: u8| {
            let mut sample = Sample::default();
            sample.view(&[10, 20, 30], &json!({}));
            sample.view(&[0, replaced], &json!({}));
            sample.view(&[7, 8], &json!({}));
            let mut accessor = json!({
                "componentType": 5121, "count": 3, "type": "SCALAR",
                "sparse": {
                    "count": 2,
                    "indices": {"bufferView": 1, "componentType": 5121},
                    "values": {"bufferView": 2}
                }
            });
            if let Some(view) = base {
                accessor["bufferView"] = view.into();
            }
            sample.accessor(accessor);
            with(&sample, |accessor| accessor.unsigned::<1>())
        };
        assert_eq!(with_base(Some(0), 2).unwrap(), [[7], [20], [8]]);
        assert_eq!(with_base(None, 1).unwrap(), [[7], [8], [0]]);
        assert_eq!(with_base(None, 3).unwrap_err().kind, ReadErrorKind::Bounds);
    }

    #[test]
    fn zeros_are_limited() {
        let zeros = |count: u64| {
            let mut sample = Sample::default();
            sample.accessor(json!({"componentType": 5126, "count": count, "type": "VEC3"}));
            numbers::<3>(&sample)
        };
        assert_eq!(zeros(2).unwrap(), [[0.0; 3]; 2]);
        assert_eq!(zeros(1 << 40).unwrap_err().kind, ReadErrorKind::Bounds);
    }

    #[test]
    fn indices_may_be_of_a_signed_type() {
        let read = |component: u32, count: u32, bytes: &[u8]| {
            let accessor = json!({"componentType": component, "count": count, "type": "SCALAR"});
            with(&sample(bytes, &json!({}), accessor), |accessor| accessor.indices())
        };
        assert_eq!(read(5120, 2, &[3, 127]).unwrap(), [3, 127]);
        assert_eq!(read(5122, 2, &[2, 1, 0xff, 0x7f]).unwrap(), [258, 32_767]);
        assert_eq!(read(5124, 2, &[2, 1, 0, 0, 0, 0, 1, 0]).unwrap(), [258, 65_536]);
        assert_eq!(read(5123, 1, &[0xff, 0xff]).unwrap(), [65_535]);
        for (component, bytes) in [(5120, &[0, 255][..]), (5122, &[0, 0, 255, 255])] {
            let error = read(component, 2, bytes).unwrap_err();
            assert_eq!(error.place, Some(Place::Part("accessors[0]".into())));
            assert_eq!(
                (error.kind, &*error.what),
                (ReadErrorKind::Syntax, "has the index -1 at 1")
            );
        }
        assert!(read(5124, 1, &[0, 0, 0, 128]).is_err());
        assert!(read(5126, 1, &[0; 4]).is_err(), "floats");
        assert!(read(5127, 1, &[0; 4]).is_err(), "unknown");
    }

    #[test]
    fn the_type_of_elements_is_checked() {
        let accessor = json!({"componentType": 5126, "count": 1, "type": "VEC4"});
        let sample = sample(&[0; 16], &json!({}), accessor);
        let error = numbers::<3>(&sample).unwrap_err();
        assert_eq!(error.place, Some(Place::Part("accessors[0]".into())));
        assert!(error.what.contains("4 numbers instead of 3"), "{error}");
        let error = with(&sample, |accessor| accessor.unsigned::<4>()).unwrap_err();
        assert!(error.what.contains("unsigned"), "{error}");
    }
}
