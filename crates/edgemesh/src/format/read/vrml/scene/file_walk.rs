//! Walks the files of a scene: the model's file, and those that it inlines with `Inline`
//! (VRML 97 6.25) or `WWWInline` (VRML 1.0).
//!
//! Only files in the folder of the inlining file or below are opened. A missing file gives a
//! warning; a file with a fault is an error in that file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::inline_request::InlineRequest;
use super::placement::Placement;
use super::scene_builder::SceneBuilder;
use super::{walk_v1, walk_v2};
use crate::format::read::byte_order_mark::without_mark;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::vrml::parse::{Document, NodeRef, Version, decode};
use crate::model::Model;
use crate::report::{Report, WarningCode};

/// How deep files may inline each other. Each level takes stack; scenes on the web were two
/// or three levels deep.
const MAX_DEPTH: usize = 32;

/// Builds the model of a scene; `path` is its file.
///
/// # Errors
/// Fails if a node or an inlined file has a fault, files inline each other in a cycle, or
/// the scene generates too many elements.
pub(crate) fn build_model(
    document: &Document,
    path: Option<PathBuf>,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let mut builder = SceneBuilder::new(report);
    builder.allow(document);
    let open = path.into_iter().collect();
    let mut walk = FileWalk { builder: &mut builder, documents: HashMap::new(), open };
    walk.walk(document, Placement::default())?;
    Ok(builder.finish())
}

struct FileWalk<'b, 'r> {
    builder: &'b mut SceneBuilder<'r>,
    /// The inlined files by path; each is parsed once.
    documents: HashMap<PathBuf, Rc<Document>>,
    /// The files that are being walked, each inlined by the previous one.
    open: Vec<PathBuf>,
}

/// Why a file is not inlined.
enum InlineFailure {
    /// The file is left out; the message follows its name in a sentence.
    LeftOut(String),
    /// The scene cannot be read.
    Error(ReadError),
}

impl From<String> for InlineFailure {
    fn from(why: String) -> Self {
        Self::LeftOut(why)
    }
}

impl From<ReadError> for InlineFailure {
    fn from(error: ReadError) -> Self {
        Self::Error(error)
    }
}

impl FileWalk<'_, '_> {
    /// Adds the nodes of a file, and the files that it inlines.
    fn walk(&mut self, document: &Document, placement: Placement) -> Result<(), ReadError> {
        match document.version {
            Version::One => {
                let mut walk = walk_v1::Walk::new(document, placement);
                self.run(|builder| walk.run(builder))
            }
            Version::Two => {
                let mut walk = walk_v2::Walk::new(document, placement);
                self.run(|builder| walk.run(builder))
            }
        }
    }

    /// Calls `walk` and inlines the file that it requests, until there is none.
    fn run<'d>(
        &mut self,
        mut walk: impl FnMut(&mut SceneBuilder) -> Result<Option<InlineRequest<'d>>, ReadError>,
    ) -> Result<(), ReadError> {
        while let Some(request) = walk(self.builder)? {
            self.inline(request)?;
        }
        Ok(())
    }

    /// Adds the first file of a request that can be opened.
    fn inline(&mut self, request: InlineRequest) -> Result<(), ReadError> {
        let InlineRequest { node, field, placement } = request;
        let mut first_message = None;
        for url in node.words(field).filter(|url| !url.is_empty()) {
            match self.find(node, url) {
                Ok((path, document)) => return self.walk_inlined(node, path, &document, placement),
                Err(InlineFailure::Error(error)) => return Err(error),
                Err(InlineFailure::LeftOut(why)) => {
                    _ = first_message.get_or_insert_with(|| format!("inlined file {url} {why}"));
                }
            }
        }
        if let Some(message) = first_message {
            self.builder.warn(node, WarningCode::Uri, || message);
        }
        Ok(())
    }

    /// The file at `url`, relative to the file of `node`.
    fn find(&mut self, node: NodeRef, url: &str) -> Result<(PathBuf, Rc<Document>), InlineFailure> {
        if url.contains("://") || url.starts_with("urn:") {
            return Err(InlineFailure::LeftOut("is on the network and was not fetched".into()));
        }
        let origin = &node.document.origin;
        let path = origin.source().sidecar_path(url)?;
        let error = |kind, what| InlineFailure::Error(origin.error(kind, node.line(), what));
        if self.open.contains(&path) {
            let what = format!("{url} inlines itself; remove this node");
            return Err(error(ReadErrorKind::Cycle, what));
        }
        if self.open.len() > MAX_DEPTH {
            let what = format!("files inline each other more than {MAX_DEPTH} deep; join them");
            return Err(error(ReadErrorKind::Size, what));
        }
        let document = match self.documents.get(&path) {
            Some(document) => Rc::clone(document),
            None => self.load(node, url, &path)?,
        };
        Ok((path, document))
    }

    fn load(
        &mut self,
        node: NodeRef,
        url: &str,
        path: &Path,
    ) -> Result<Rc<Document>, InlineFailure> {
        let origin = &node.document.origin;
        let bytes = origin.source().sidecar(url)?;
        if !is_vrml(&bytes) {
            return Err(InlineFailure::LeftOut("is not a VRML file".into()));
        }
        let document = decode(origin.inlined(url, path), &bytes, self.builder.report)?;
        let document = Rc::new(document);
        self.builder.allow(&document);
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
        let outer_line = self.builder.inline_line;
        self.builder.inline_line = outer_line.or(Some(node.line()));
        self.open.push(path);
        let result = self.walk(document, placement);
        self.open.pop();
        self.builder.inline_line = outer_line;
        result
    }
}

/// Whether a file begins like VRML or gzip.
fn is_vrml(bytes: &[u8]) -> bool {
    without_mark(bytes).starts_with(b"#VRML") || bytes.starts_with(b"\x1f\x8b")
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
    fn files_of_both_versions_are_inlined_relative_to_their_folders() {
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
        assert!(report.warnings().is_empty(), "the second URL was used: {report:?}");
        assert_eq!((model.positions.len(), model.polygon_count()), (16, 12));
        assert_eq!(model.positions[7], [6.0, 2.0, 2.0]);
        assert_eq!((model.polygon_lines[0], model.polygon_lines[6]), (4, 5), "the model's lines");
        assert_eq!(model.groups, ["outer"]);
    }

    #[test]
    fn missing_files_give_a_warning() {
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
    fn a_cycle_of_files_is_an_error() {
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
