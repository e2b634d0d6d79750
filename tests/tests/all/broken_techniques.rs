//! Broken technique and shader files with their exact messages.
//!
//! `tests/broken_techniques/cases.txt` has the files, `expected.txt` the messages;
//! `UPDATE_EXPECTED=1` rewrites `expected.txt`. Read it before you commit it.

use std::fmt::Write as _;
use std::path::Path;

use testkit::locate::workspace_root;
use viewer::technique::library::Library;
use viewer::technique::plan::Plan;
use viewer::technique::program::ShaderFiles;

/// The sections of a text by their first lines.
fn sections<'t>(text: &'t str, mark: &str) -> Vec<(&'t str, &'t str)> {
    let mut sections = Vec::new();
    let mut rest = text.strip_prefix(mark);
    while let Some(section) = rest {
        let next = section.find(&format!("\n{mark}"));
        let (own, behind) = match next {
            Some(at) => (&section[..=at], section.get(at + 1..)),
            None => (section, None),
        };
        let (name, body) = own.split_once('\n').unwrap_or((own, ""));
        sections.push((name.trim(), body));
        rest = behind.and_then(|behind| behind.strip_prefix(mark));
    }
    sections
}

/// The messages for the files of a case, without the name of their folder.
fn told(folder: &Path, files: &str) -> String {
    for (name, text) in sections(files, "--- ") {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let mistakes = Library::shipped().check(&folder.join("technique.toml"), None);
    mistakes
        .to_string()
        .replace(&format!("{}/", folder.display()), "")
        .replace(&folder.display().to_string(), "its folder")
}

#[test]
fn every_broken_file_has_its_exact_message() {
    let folder = workspace_root().join("tests/broken_techniques");
    let cases = std::fs::read_to_string(folder.join("cases.txt")).unwrap();
    let cases = sections(&cases, "=== ");
    assert!(cases.len() >= 40, "{} cases", cases.len());
    let mut found = String::new();
    for (name, files) in cases {
        let own = tempfile::tempdir().unwrap();
        let message = told(own.path(), files);
        assert!(!message.trim().is_empty(), "{name}: no message");
        let _ = write!(found, "=== {name}\n{message}\n");
    }
    let path = folder.join("expected.txt");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap();
    for (found, expected) in sections(&found, "=== ").iter().zip(sections(&expected, "=== ")) {
        assert_eq!(*found, expected, "see CONTRIBUTING.md on UPDATE_EXPECTED");
    }
    assert_eq!(found, expected, "the numbers of cases and messages differ");
}

/// Built-in files, broken at random: mistakes, but no panic.
#[test]
fn no_technique_file_is_a_panic() {
    let folder = workspace_root().join("techniques");
    let mut texts: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            texts.push(std::fs::read_to_string(path).unwrap());
        }
    }
    let own = tempfile::tempdir().unwrap();
    let path = own.path().join("technique.toml");
    let library = Library::shipped();
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap() % below.max(1)
    };
    let mut refused = 0;
    for round in 0..1500 {
        let mut bytes = texts[round % texts.len()].clone().into_bytes();
        for _ in 0..=random(3) {
            let (at, other) = (random(bytes.len()), random(bytes.len()));
            match random(4) {
                0 => drop(bytes.remove(at)),
                1 => bytes[at] = bytes[other],
                2 => bytes.insert(at, b"[]{}\"=,.#\n<:-0"[random(14)]),
                _ => bytes.swap(at, other),
            }
        }
        std::fs::write(&path, &bytes).unwrap();
        match library.technique_file(&path) {
            Ok((technique, _)) => {
                let shaders = ShaderFiles::new(&technique.folders, None);
                refused += usize::from(Plan::of(&technique, &shaders).is_err());
            }
            Err(mistakes) => {
                refused += usize::from(!mistakes.to_string().is_empty());
            }
        }
    }
    assert!(refused > 500, "{refused} of 1500 were refused");
}
