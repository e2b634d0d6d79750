//! WGSL with one small include: `#import <common/mesh.wgsl>`, one a line, above
//! everything but comments, the path from the shader folder.
//!
//! Each file comes once per module, in the order of need; a cycle is an error.
//! A line map leads from the joined text back to the file that was written, so
//! that an error names what its reader has open.
//!
//! Rejected: a preprocessor with definitions and conditions. `override`
//! constants make variants, and really different shaders are different files.

use thiserror::Error;

use crate::files::text;

/// A shader module's text, joined from its files.
#[derive(Debug, Clone)]
pub struct ShaderSource {
    /// The whole text.
    pub text: String,
    /// Where each line of `text` comes from.
    lines: Vec<Origin>,
    /// The files in `text`, by the index in [`Origin`].
    files: Vec<String>,
}

#[derive(Debug, Clone, Copy)]
struct Origin {
    file: usize,
    line: usize,
}

/// What is wrong with a shader, and where.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}:{line}: {message}")]
pub struct ShaderError {
    /// The file, path from the shader folder.
    pub file: String,
    /// The line in that file, counted from 1.
    pub line: usize,
    /// The column in bytes, counted from 1.
    pub column: usize,
    /// How many bytes of the line it is about.
    pub length: usize,
    /// What is wrong.
    pub message: String,
}

impl ShaderSource {
    /// Joins the file `root` with all that it imports; `load` gives the text of
    /// a path from the shader folder.
    ///
    /// # Errors
    /// A missing file, an import in the wrong place, or a cycle.
    pub fn resolve(root: &str, load: &dyn Fn(&str) -> Option<String>) -> Result<Self, ShaderError> {
        let mut source = Self { text: String::new(), lines: Vec::new(), files: Vec::new() };
        let missing = || ShaderError {
            file: root.into(),
            line: 1,
            column: 1,
            length: 0,
            message: "there is no such shader".into(),
        };
        let text = load(root).ok_or_else(missing)?;
        source.append(root, &text, load, &mut vec![root.to_owned()])?;
        Ok(source)
    }

    /// Joins an embedded shader.
    ///
    /// # Errors
    /// As [`Self::resolve`]; a test resolves them all, so this does not happen to a
    /// released crate.
    pub fn embedded(root: &str) -> Result<Self, ShaderError> {
        Self::embedded_with(root, &|_| None)
    }

    /// Joins an embedded shader; `replace` names the file that is taken for a path, where
    /// it is another one.
    ///
    /// # Errors
    /// As [`Self::embedded`].
    pub fn embedded_with(
        root: &str,
        replace: &dyn Fn(&str) -> Option<&'static str>,
    ) -> Result<Self, ShaderError> {
        Self::resolve(root, &|path| text(replace(path).unwrap_or(path)).map(str::to_owned))
    }

    fn append(
        &mut self,
        path: &str,
        text: &str,
        load: &dyn Fn(&str) -> Option<String>,
        stack: &mut Vec<String>,
    ) -> Result<(), ShaderError> {
        let mut body = Vec::new();
        let mut is_head = true;
        for (index, line) in text.lines().enumerate() {
            let error = |message: String| ShaderError {
                file: path.into(),
                line: index + 1,
                column: 1,
                length: line.len(),
                message,
            };
            if !line.trim_start().starts_with("#import") {
                is_head &= line.trim().is_empty() || line.trim_start().starts_with("//");
                body.push((index + 1, line));
                continue;
            }
            let wanted = import_path(line).ok_or_else(|| {
                error(format!("'{line}' is not of the form #import <folder/file.wgsl>"))
            })?;
            if !is_head {
                return Err(error("imports stand above all other code".into()));
            }
            if stack.iter().any(|open| open == wanted) {
                return Err(error(format!("{wanted} imports itself: {}", stack.join(" > "))));
            }
            // The line stays as a comment, so that line numbers stay whole.
            body.push((index + 1, ""));
            if self.files.iter().any(|known| known == wanted) {
                continue;
            }
            let imported = load(wanted).ok_or_else(|| error(format!("there is no {wanted}")))?;
            stack.push(wanted.to_owned());
            self.append(wanted, &imported, load, stack)?;
            stack.pop();
        }
        let file = self.files.len();
        self.files.push(path.to_owned());
        for (line, text) in body {
            self.text.push_str(text);
            self.text.push('\n');
            self.lines.push(Origin { file, line });
        }
        Ok(())
    }

    /// The file and line that line `line` (from 1) of the joined text comes from.
    #[must_use]
    pub fn origin(&self, line: usize) -> (&str, usize) {
        let last = self.lines.len().saturating_sub(1);
        self.lines
            .get(line.saturating_sub(1).min(last))
            .map_or(("", 0), |origin| (self.files[origin.file].as_str(), origin.line))
    }

    /// The files that the text was joined from, each behind what it imports.
    #[must_use]
    pub fn files(&self) -> &[String] {
        &self.files
    }

    /// Parses and validates the module as wgpu will.
    ///
    /// # Errors
    /// The first mistake, at the file and line where it was written.
    pub fn validate(&self) -> Result<naga::Module, ShaderError> {
        self.reflect().map(|(module, _)| module)
    }

    /// As [`Self::validate`], with what is known of the functions.
    ///
    /// # Errors
    /// As [`Self::validate`].
    pub fn reflect(&self) -> Result<(naga::Module, naga::valid::ModuleInfo), ShaderError> {
        let module = naga::front::wgsl::parse_str(&self.text)
            .map_err(|error| self.error_at(error.location(&self.text), error.message()))?;
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::default(),
        );
        let info = validator.validate(&module).map_err(|error| {
            let location = error.location(&self.text);
            let error = error.into_inner();
            let causes =
                std::iter::successors(Some(&error as &dyn std::error::Error), |e| e.source());
            let causes: Vec<String> = causes.map(ToString::to_string).collect();
            self.error_at(location, &causes.join(": "))
        })?;
        Ok((module, info))
    }

    fn error_at(&self, at: Option<naga::SourceLocation>, message: &str) -> ShaderError {
        let (line, column, length) = at.map_or((1, 1, 0), |at| {
            (at.line_number as usize, at.line_position as usize, at.length as usize)
        });
        // Of what goes over several lines the first one is shown.
        let rest = self.text.lines().nth(line.saturating_sub(1)).map_or(0, str::len);
        let length = length.min((rest + 1).saturating_sub(column));
        let (file, line) = self.origin(line);
        ShaderError { file: file.into(), line, column, length, message: message.to_owned() }
    }
}

/// The path in `#import <path>`.
fn import_path(line: &str) -> Option<&str> {
    let path = line.trim().strip_prefix("#import")?.trim();
    let path = path.strip_prefix('<')?.strip_suffix('>')?;
    (!path.is_empty() && !path.contains(['<', '>'])).then_some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(path: &str) -> Option<String> {
        let text = match path {
            "root.wgsl" => "// Head.\n#import <a.wgsl>\n#import <b.wgsl>\nfn root() {}\n",
            "a.wgsl" => "#import <b.wgsl>\nfn a() {}\n",
            "b.wgsl" => "fn b() {}\n",
            "loop.wgsl" => "#import <pool.wgsl>\n",
            "pool.wgsl" => "#import <loop.wgsl>\n",
            "late.wgsl" => "fn late() {}\n#import <b.wgsl>\n",
            "odd.wgsl" => "#import b.wgsl\n",
            "lost.wgsl" => "\n#import <nowhere.wgsl>\n",
            "wrong.wgsl" => "#import <b.wgsl>\n\nfn wrong() { let x = 1 + true; }\n",
            _ => return None,
        };
        Some(text.to_owned())
    }

    fn resolve(root: &str) -> Result<ShaderSource, ShaderError> {
        ShaderSource::resolve(root, &load)
    }

    #[test]
    fn each_file_comes_once_before_its_user() {
        let source = resolve("root.wgsl").unwrap();
        let functions: Vec<&str> =
            source.text.lines().filter(|line| line.starts_with("fn")).collect();
        assert_eq!(functions, ["fn b() {}", "fn a() {}", "fn root() {}"]);
        let place = source.text.lines().position(|line| line.contains("root")).unwrap();
        assert_eq!(source.origin(place + 1), ("root.wgsl", 4));
    }

    #[test]
    fn mistakes_name_their_file_and_line() {
        let error = |root: &str| resolve(root).unwrap_err().to_string();
        assert_eq!(error("none.wgsl"), "none.wgsl:1: there is no such shader");
        assert_eq!(error("lost.wgsl"), "lost.wgsl:2: there is no nowhere.wgsl");
        assert!(error("loop.wgsl").starts_with("pool.wgsl:1: loop.wgsl imports itself"));
        assert!(error("late.wgsl").starts_with("late.wgsl:2: imports stand above"));
        assert!(error("odd.wgsl").starts_with("odd.wgsl:1: "));
        let wrong = resolve("wrong.wgsl").unwrap().validate().unwrap_err();
        assert_eq!((wrong.file.as_str(), wrong.line), ("wrong.wgsl", 3));
    }
}
