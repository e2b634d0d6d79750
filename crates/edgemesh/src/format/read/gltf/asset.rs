//! A file's JSON with its buffers, and a budget for what is read of them.

use std::cell::{Cell, OnceCell};

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::document::Document;
use crate::index::MAX_INDEX;
use crate::report::Place;

/// How many elements accessors and instances may yield beyond one for each byte of
/// the files: about 3 GiB of positions, more than any scene that is drawn at once.
/// Only a file that uses its data many times reaches the limit.
pub(super) const SHARED_ELEMENTS: usize = 1 << 27;

/// A file's JSON with its buffers.
#[derive(Debug)]
pub(super) struct Asset<'a> {
    pub(super) source: &'a Source<'a>,
    pub(super) document: &'a Document,
    /// The binary chunk of a GLB file.
    pub(super) binary: Option<&'a [u8]>,
    /// The bytes of each buffer with a URI, read at the first use.
    pub(super) loaded_buffers: Vec<OnceCell<Result<Vec<u8>, ReadError>>>,
    /// The bytes of each compressed view, decoded at the first use; `None` if it is not
    /// compressed.
    pub(super) decoded_views: Vec<OnceCell<Result<Option<Vec<u8>>, ReadError>>>,
    pub(super) budget: Budget,
}

impl<'a> Asset<'a> {
    /// The asset of a document; `binary` is the binary chunk of a GLB file.
    pub(super) fn new(
        source: &'a Source<'a>,
        document: &'a Document,
        binary: Option<&'a [u8]>,
    ) -> Self {
        let loaded_buffers = document.buffers.iter().map(|_| OnceCell::new()).collect();
        let budget = Budget::new(source.bytes.len());
        let decoded_views = document.buffer_views.iter().map(|_| OnceCell::new()).collect();
        Self { source, document, binary, loaded_buffers, decoded_views, budget }
    }

    /// An error at a part of the JSON, such as `nodes[3]`.
    pub(super) fn error(
        &self,
        kind: ReadErrorKind,
        part: String,
        what: impl Into<String>,
    ) -> ReadError {
        self.source.error(kind, Some(Place::Part(part)), what)
    }

    /// The element of `list` with this index, which `part` refers to; `list_name` is
    /// the name of the list in the JSON.
    ///
    /// # Errors
    /// `Syntax` if the index is out of range.
    pub(super) fn get<T>(
        &self,
        list: &'a [T],
        index: usize,
        list_name: &str,
        part: impl FnOnce() -> String,
    ) -> Result<&'a T, ReadError> {
        list.get(index).ok_or_else(|| {
            let what = format!("names {list_name}[{index}]; there are {}", list.len());
            self.error(ReadErrorKind::Syntax, part(), what)
        })
    }

    /// Takes `elements` from the budget for `part`.
    ///
    /// # Errors
    /// `Size` if the budget is exceeded.
    pub(super) fn spend(
        &self,
        elements: usize,
        part: impl FnOnce() -> String,
    ) -> Result<(), ReadError> {
        if self.budget.take(elements) {
            return Ok(());
        }
        let what = "too large: instances and shared accessors yield too many elements; \
                    split the scene";
        Err(self.error(ReadErrorKind::Size, part(), what))
    }
}

/// Limits the number of elements by the number of bytes that were read.
#[derive(Debug)]
pub(super) struct Budget {
    bytes: Cell<usize>,
    spent: Cell<usize>,
}

impl Budget {
    const fn new(bytes: usize) -> Self {
        Self { bytes: Cell::new(bytes), spent: Cell::new(0) }
    }

    /// The bytes read so far, of the model file and others.
    pub(super) const fn bytes(&self) -> usize {
        self.bytes.get()
    }

    /// Adds the bytes of another file.
    pub(super) fn add_bytes(&self, bytes: usize) {
        self.bytes.set(self.bytes.get().saturating_add(bytes));
    }

    /// Takes `elements`; returns whether they are within the budget.
    fn take(&self, elements: usize) -> bool {
        self.spent.set(self.spent.get().saturating_add(elements));
        let limit = self.bytes.get().saturating_add(SHARED_ELEMENTS).min(MAX_INDEX);
        self.spent.get() <= limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_data_cannot_multiply_without_limit() {
        let document = Document::default();
        let source = Source { name: "test.gltf", folder: None, bytes: b"12345" };
        let asset = Asset::new(&source, &document, None);
        asset.budget.add_bytes(3);
        assert!(asset.spend(SHARED_ELEMENTS, String::new).is_ok());
        assert!(asset.spend(8, String::new).is_ok(), "one for each byte");
        let error = asset.spend(1, || "accessors[4]".into()).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Size);
        assert_eq!(error.place, Some(Place::Part("accessors[4]".into())));
        assert!(asset.spend(usize::MAX, String::new).is_err());
    }
}
