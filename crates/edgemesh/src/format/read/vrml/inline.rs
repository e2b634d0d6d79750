//! Other files in the place of a node: `Inline` of VRML 97 6.25, `WWWInline` of
//! VRML 1.0.
//!
//! Only files in the folder of the inlining file or below are opened, and never
//! anything else. A file that is not there costs a warning; one that is there
//! and broken is an error in that file.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::document::{Document, NodeRef};
use super::parse;
use super::scene::{Placement, Scene};
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::report::WarningCode;

/// How deep files may inline each other. Each level takes stack, and scenes on
/// the web were two or three deep.
const MAX_DEPTH: usize = 32;

/// Why a file is not inlined.
enum Refusal {
    /// It is left out; the words go behind its name in a sentence.
    LeftOut(String),
    /// The scene cannot be read.
    Broken(ReadError),
}

impl From<String> for Refusal {
    fn from(why: String) -> Self {
        Self::LeftOut(why)
    }
}

impl From<ReadError> for Refusal {
    fn from(error: ReadError) -> Self {
        Self::Broken(error)
    }
}

impl Scene<'_> {
    /// Adds the scene of the first file that `field` names and that is there.
    ///
    /// # Errors
    /// [`ReadErrorKind::Cycle`] where that file is being read already, and all
    /// errors in it.
    pub(super) fn inline(
        &mut self,
        node: NodeRef,
        field: &str,
        placement: Placement,
    ) -> Result<(), ReadError> {
        let mut left_out = None;
        for url in node.words(field).filter(|url| !url.is_empty()) {
            match self.find(node, url) {
                Ok((path, document)) => return self.walk_inlined(node, path, &document, placement),
                Err(Refusal::Broken(error)) => return Err(error),
                Err(Refusal::LeftOut(why)) => {
                    left_out = left_out.or_else(|| Some(format!("inlined file {url} {why}")));
                }
            }
        }
        if let Some(message) = left_out {
            self.warn(node, WarningCode::Uri, || message);
        }
        Ok(())
    }

    /// The file that `url` leads to.
    fn find(&mut self, node: NodeRef, url: &str) -> Result<(PathBuf, Rc<Document>), Refusal> {
        if url.contains("://") || url.starts_with("urn:") {
            return Err(Refusal::LeftOut("is on the network and was not fetched".into()));
        }
        let origin = &node.document.origin;
        let path = origin.source().sidecar_path(url)?;
        let error = |kind, what| Refusal::Broken(origin.error(kind, node.line(), what));
        if self.open.contains(&path) {
            let what = format!("{url} inlines itself: take this node out");
            return Err(error(ReadErrorKind::Cycle, what));
        }
        if self.open.len() > MAX_DEPTH {
            let what = format!("files inline each other more than {MAX_DEPTH} deep: join them");
            return Err(error(ReadErrorKind::Size, what));
        }
        let document = match self.documents.get(&path) {
            Some(document) => Rc::clone(document),
            None => self.load(node, url, &path)?,
        };
        Ok((path, document))
    }

    fn load(&mut self, node: NodeRef, url: &str, path: &Path) -> Result<Rc<Document>, Refusal> {
        let origin = &node.document.origin;
        let bytes = origin.source().sidecar(url)?;
        if !is_vrml(&bytes) {
            return Err(Refusal::LeftOut("is no VRML file".into()));
        }
        let document = Rc::new(parse(origin.inlined(url, path), &bytes, self.report)?);
        self.allow(&document);
        self.documents.insert(path.into(), Rc::clone(&document));
        Ok(document)
    }

    fn walk_inlined(
        &mut self,
        node: NodeRef,
        path: PathBuf,
        document: &Document,
        placement: Placement,
    ) -> Result<(), ReadError> {
        let outer_line = self.inline_line;
        self.inline_line = outer_line.or(Some(node.line()));
        self.open.push(path);
        let result = self.walk(document, placement);
        self.open.pop();
        self.inline_line = outer_line;
        result
    }
}

/// Whether a file begins as VRML does, or as gzip.
fn is_vrml(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.starts_with(b"#VRML") || bytes.starts_with(b"\x1f\x8b")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::format::read::read_model;
    use crate::model::Model;
    use crate::report::{Place, Report};

    const TWO: &str = "#VRML V2.0 utf8\n";
    const ONE: &str = "#VRML V1.0 ascii\n";
    const BOX: &str = "Shape { geometry Box { } }";

    /// Reads the first of some files in a folder.
    fn read(files: &[(&str, String)]) -> Result<(Model, Report), ReadError> {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        read_model(&folder.path().join(files[0].0))
    }

    #[test]
    fn files_of_both_versions_are_inlined_from_where_they_lie() {
        let (model, report) = read(&[
            (
                "a.wrl",
                format!(
                    "{TWO}DEF outer Transform {{ translation 4 0 0\n
                     children [ Inline {{ url [ \"none.wrl\" \"below/b.wrl\" ] }}
                     Inline {{ url \"below/b.wrl\" }} ] }}"
                ),
            ),
            (
                "below/b.wrl",
                format!("{ONE}Scale {{ scaleFactor 2 2 2 }}\nWWWInline {{ name \"c.wrl\" }}"),
            ),
            ("below/c.wrl", format!("{TWO}{BOX}")),
        ])
        .unwrap();
        assert!(report.warnings().is_empty(), "another place was found: {report:?}");
        assert_eq!((model.positions.len(), model.polygon_count()), (16, 12));
        assert_eq!(model.positions[7], [6.0, 2.0, 2.0]);
        assert_eq!((model.polygon_lines[0], model.polygon_lines[6]), (4, 5), "the model's lines");
        assert_eq!(model.groups, ["outer"]);
    }

    #[test]
    fn what_is_not_there_costs_a_warning() {
        for url in ["none.wrl", "../a.wrl", "http://example.org/a.wrl", "urn:x", "a.png"] {
            let files = [
                ("a.wrl", format!("{TWO}{BOX}\nInline {{ url \"{url}\" }} Inline {{ url \"\" }}")),
                ("a.png", "no scene".into()),
            ];
            let (model, report) = read(&files).unwrap();
            assert_eq!((model.polygon_count(), report.count(WarningCode::Uri)), (6, 1), "{url}");
            assert_eq!(report.warnings()[0].place, Some(Place::Line(3)));
        }
    }

    #[test]
    fn warnings_and_errors_of_inlined_files_name_them() {
        let main = ("a.wrl", format!("{TWO}Inline {{ url \"b.wrl\" }}"));
        let (_, report) =
            read(&[main.clone(), ("b.wrl", format!("{TWO}{BOX}\nUnknown {{ }}"))]).unwrap();
        let place = report.warnings()[0].place.as_ref().unwrap().behind("a.wrl");
        assert!(place.ends_with("b.wrl:3"), "{place}");
        let error = read(&[main, ("b.wrl", format!("{TWO}\nGroup {{"))]).unwrap_err();
        assert!(error.file.ends_with("b.wrl"), "{error}");
        assert_eq!((error.kind, error.place), (ReadErrorKind::Syntax, Some(Place::Line(3))));
    }

    #[test]
    fn files_in_a_circle_are_an_error() {
        let error = read(&[
            ("a.wrl", format!("{TWO}Inline {{ url \"b.wrl\" }}")),
            ("b.wrl", format!("{ONE}\nWWWInline {{ name \"./a.wrl\" }}")),
        ])
        .unwrap_err();
        assert_eq!((error.kind, error.place), (ReadErrorKind::Cycle, Some(Place::Line(3))));
    }

    #[test]
    fn too_many_levels_are_an_error() {
        let inlining = |depth: usize| format!("{TWO}Inline {{ url \"{}.wrl\" }}", depth + 1);
        let scene = |depth: usize| {
            let mut files: Vec<_> =
                (0..depth).map(|depth| (format!("{depth}.wrl"), inlining(depth))).collect();
            files.push((format!("{depth}.wrl"), format!("{TWO}{BOX}")));
            let files: Vec<_> =
                files.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
            read(&files)
        };
        assert_eq!(scene(MAX_DEPTH).unwrap().0.polygon_count(), 6);
        assert_eq!(scene(MAX_DEPTH + 1).unwrap_err().kind, ReadErrorKind::Size);
    }

    #[test]
    fn a_stream_inlines_nothing() {
        let text = format!("{TWO}{BOX} Inline {{ url \"a.wrl\" }}");
        let bytes = text.as_bytes();
        let (_, report) =
            crate::format::read::read_model_stream(bytes, Path::new("a.wrl"), None).unwrap();
        assert!(report.warnings()[0].message.contains("stream"), "{report:?}");
    }
}
