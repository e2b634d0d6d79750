//! Elements of a part, one after the other.
//!
//! Source: W3C, *Extensible Markup Language 1.0* and *Namespaces in XML 1.0*, as the
//! crate `quick-xml` reads them. It knows no entities but the five predefined ones, so
//! none can expand.
//!
//! ```text
//! <a> <b/> text <c> <d/> </c> </a>      child: b, c, end of a
//!     after c, `child` enters it, and `skip` passes over it
//! ```

use std::borrow::Cow;

use quick_xml::XmlVersion;
use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};
use quick_xml::name::{QName, ResolveResult};
use quick_xml::reader::NsReader;

use super::super::byte_order_mark::without_mark;
use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::quoted;
use crate::report::{Place, Report, WarningCode};

/// The most elements within each other; 3MF needs seven.
const MAX_DEPTH: u32 = 100;

/// The start of the names of all versions of the core namespace.
const CORE: &[u8] = b"http://schemas.microsoft.com/3dmanufacturing/core/";

/// The namespaces of supported extensions.
const MATERIALS: &[u8] = b"http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
const PRODUCTION: &[u8] = b"http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// The namespace of relationships between parts.
const RELATIONSHIPS: &[u8] = b"http://schemas.openxmlformats.org/package/2006/relationships";

/// A namespace, as far as the reader knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Namespace {
    Core,
    Materials,
    Production,
    Relationships,
    Other,
}

impl Namespace {
    fn of(name: &ResolveResult) -> Self {
        match name {
            ResolveResult::Bound(name) => match name.as_ref() {
                MATERIALS => Self::Materials,
                PRODUCTION => Self::Production,
                RELATIONSHIPS => Self::Relationships,
                name if name.starts_with(CORE) => Self::Core,
                _ => Self::Other,
            },
            ResolveResult::Unbound | ResolveResult::Unknown(_) => Self::Other,
        }
    }
}

/// The elements of a part.
pub(super) struct Xml<'s, 'a> {
    source: &'s Source<'s>,
    /// The name of the part.
    part: &'s str,
    text: &'a [u8],
    reader: NsReader<&'a [u8]>,
    /// The open elements.
    depth: u32,
    /// An offset and its line; later lines are counted from there.
    counted: (usize, u32),
}

/// An element and its attributes.
#[derive(Debug)]
pub(super) struct Element<'a> {
    pub(super) namespace: Namespace,
    start: BytesStart<'a>,
}

impl<'s, 'a> Xml<'s, 'a> {
    /// The elements of `text`, which is the part `part`.
    ///
    /// # Errors
    /// Format: the text is UTF-16.
    pub(super) fn new(
        source: &'s Source<'s>,
        part: &'s str,
        text: &'a [u8],
    ) -> Result<Self, ReadError> {
        let text = without_mark(text);
        let mut reader = NsReader::from_reader(text);
        reader.config_mut().expand_empty_elements = true;
        let xml = Self { source, part, text, reader, depth: 0, counted: (0, 1) };
        if text.starts_with(b"\xff\xfe") || text.starts_with(b"\xfe\xff") {
            let what = "is UTF-16 text; save it as UTF-8";
            let place = Some(Place::Part(part.to_owned()));
            return Err(source.error(ReadErrorKind::Format, place, what));
        }
        Ok(xml)
    }

    /// The root element.
    ///
    /// # Errors
    /// Syntax: there is none, or the XML is malformed.
    pub(super) fn root(&mut self) -> Result<Element<'a>, ReadError> {
        match self.child()? {
            Some(element) => Ok(element),
            None => Err(self.error(ReadErrorKind::Syntax, "has no element")),
        }
    }

    /// The next element in the innermost open element, which is open then; `None` at the
    /// end, where the outer element is the innermost.
    ///
    /// # Errors
    /// Syntax: the XML is malformed. Truncated: the text ends within an element.
    pub(super) fn child(&mut self) -> Result<Option<Element<'a>>, ReadError> {
        loop {
            match self.reader.read_event() {
                Ok(Event::Start(start)) => {
                    self.depth += 1;
                    if self.depth > MAX_DEPTH {
                        let what = format!("has more than {MAX_DEPTH} elements within each other");
                        return Err(self.error(ReadErrorKind::Syntax, what));
                    }
                    let (name, _) = self.reader.resolver().resolve_element(start.name());
                    return Ok(Some(Element { namespace: Namespace::of(&name), start }));
                }
                Ok(Event::End(_)) => {
                    self.depth = self.depth.saturating_sub(1);
                    return Ok(None);
                }
                Ok(Event::Eof) if self.depth > 0 => {
                    let what = "the text ends within an element; the file is truncated";
                    return Err(self.error(ReadErrorKind::Truncated, what));
                }
                Ok(Event::Eof) => return Ok(None),
                Ok(_) => {}
                Err(error) => {
                    return Err(
                        self.error(ReadErrorKind::Syntax, format!("malformed XML: {error}"))
                    );
                }
            }
        }
    }

    /// Passes over the rest of the innermost open element.
    ///
    /// # Errors
    /// As [`Self::child`].
    pub(super) fn skip(&mut self) -> Result<(), ReadError> {
        let outer = self.depth.saturating_sub(1);
        while self.depth > outer {
            self.child()?;
        }
        Ok(())
    }

    /// The value of an attribute in this namespace, if the element has it.
    pub(super) fn attribute_in<'e>(
        &self,
        element: &'e Element,
        namespace: Namespace,
        local_name: &[u8],
    ) -> Option<Cow<'e, str>> {
        let is_wanted = |name: QName| {
            let (found, local) = self.reader.resolver().resolve_attribute(name);
            local.as_ref() == local_name && Namespace::of(&found) == namespace
        };
        element.attributes().find(|attribute| is_wanted(attribute.key)).map(text)
    }

    /// The name of the namespace that a prefix stands for, if it is declared.
    pub(super) fn namespace_of_prefix(&self, prefix: &str) -> Option<String> {
        let name = format!("{prefix}:name");
        match self.reader.resolver().resolve_attribute(QName(name.as_bytes())).0 {
            ResolveResult::Bound(name) => Some(String::from_utf8_lossy(name.as_ref()).into_owned()),
            ResolveResult::Unbound | ResolveResult::Unknown(_) => None,
        }
    }

    /// Passes over an element that is not supported, with a warning.
    ///
    /// # Errors
    /// As [`Self::child`].
    pub(super) fn skip_with_warning(
        &mut self,
        element: &Element,
        report: &mut Report,
    ) -> Result<(), ReadError> {
        report.warn(WarningCode::Unsupported, Some(self.place()), || {
            format!("'{}' is not supported; it was left out", element.shown_name())
        });
        self.skip()
    }

    /// An id or index that an element must have.
    ///
    /// # Errors
    /// Syntax: it is missing. Number: it is not a whole number.
    pub(super) fn required_index(
        &mut self,
        element: &Element,
        name: &[u8],
    ) -> Result<u32, ReadError> {
        self.optional_index(element, name)?.ok_or_else(|| {
            let what = format!("'{}' lacks '{}'", element.shown_name(), name.escape_ascii());
            self.error(ReadErrorKind::Syntax, what)
        })
    }

    /// An id or index that an element may have.
    ///
    /// # Errors
    /// Number: it is not a whole number.
    pub(super) fn optional_index(
        &mut self,
        element: &Element,
        name: &[u8],
    ) -> Result<Option<u32>, ReadError> {
        let Some(value) = element.attribute(name) else { return Ok(None) };
        match value.trim().parse() {
            Ok(index) => Ok(Some(index)),
            Err(_) => {
                let (name, value) = (name.escape_ascii(), quoted(value.as_bytes()));
                let what = format!("{name} is {value}, which is not a whole number");
                Err(self.error(ReadErrorKind::Number, what))
            }
        }
    }

    /// The line behind the last tag, counted from 1.
    pub(super) fn line(&mut self) -> u32 {
        let (from, line) = self.counted;
        let to = usize::try_from(self.reader.buffer_position()).unwrap_or(usize::MAX);
        let passed = self.text.get(from..to).unwrap_or_default();
        let lines = memchr::memchr_iter(b'\n', passed).count();
        self.counted =
            (to.max(from), line.saturating_add(u32::try_from(lines).unwrap_or(u32::MAX)));
        self.counted.1
    }

    /// The place of the last tag.
    pub(super) fn place(&mut self) -> Place {
        let line = self.line();
        place_of(self.part, line)
    }

    /// An error at the last tag.
    pub(super) fn error(&mut self, kind: ReadErrorKind, what: impl Into<String>) -> ReadError {
        let place = self.place();
        self.source.error(kind, Some(place), what)
    }
}

/// A line of a part.
pub(super) fn place_of(part: &str, line: u32) -> Place {
    Place::Part(format!("{part}:{line}"))
}

impl Element<'_> {
    /// The name without its prefix.
    pub(super) fn name(&self) -> &[u8] {
        self.start.local_name().into_inner()
    }

    /// The name for messages.
    pub(super) fn shown_name(&self) -> String {
        self.name().escape_ascii().to_string()
    }

    /// The value of an attribute without a prefix.
    pub(super) fn attribute(&self, name: &[u8]) -> Option<Cow<'_, str>> {
        self.attributes().find(|attribute| attribute.key == QName(name)).map(text)
    }

    /// The attributes up to a malformed one.
    pub(super) fn attributes(&self) -> impl Iterator<Item = Attribute<'_>> {
        // The check for repeated names takes quadratic time.
        let mut attributes = self.start.attributes();
        attributes.with_checks(false);
        attributes.map_while(Result::ok)
    }
}

/// The value of an attribute, with predefined entities replaced.
fn text(attribute: Attribute) -> Cow<str> {
    attribute
        .normalized_value(XmlVersion::Implicit1_0)
        .unwrap_or_else(|_| String::from_utf8_lossy(&attribute.value).into_owned().into())
}
