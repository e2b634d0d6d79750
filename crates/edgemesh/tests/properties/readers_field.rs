//! Files that people reported in other projects, made anew, with what they must give.

use edgemesh::edge_mesh::EdgeFlags;
use edgemesh::load::{LoadOptions, NoProgress, load};

use crate::readers::corpus;

/// A file, its triangles, its marked edges, and its warnings.
type Case = (&'static str, usize, usize, &'static [(&'static str, usize)]);

/// Counted by hand: each file is a box of 12 triangles.
const CASES: [Case; 5] = [
    ("json_chunk_not_padded.glb", 12, 0, &[("syntax", 1)]),
    ("nan_msvc_new.obj", 12, 0, &[("nonfinite", 1)]),
    ("nan_msvc_old.obj", 12, 0, &[("nonfinite", 1)]),
    ("outline_with_short_indices.glb", 12, 12, &[("syntax", 1)]),
    // A face behind a comment that ends in a backslash belongs to the comment.
    ("comment_that_ends_in_a_backslash.obj", 10, 0, &[("syntax", 1)]),
];

#[test]
#[expect(clippy::print_stderr, reason = "reports what was left out")]
fn reported_files_give_what_they_must() {
    let folder = corpus().map(|shared| shared.join("field/cases"));
    let Some(folder) = folder.filter(|folder| folder.is_dir()) else {
        eprintln!("left out {} reported files: set EDGEMESH_SHARED", CASES.len());
        return;
    };
    for (name, triangles, marked, warnings) in CASES {
        let loaded = load(&folder.join(name), &LoadOptions::default(), &NoProgress).unwrap();
        let mesh = &loaded.mesh;
        let found = mesh.records.iter().filter(|record| record.flags().contains(EdgeFlags::MARKED));
        assert_eq!((mesh.triangles.len(), found.count()), (triangles, marked), "{name}");
        let found: Vec<(&str, usize)> = loaded
            .report
            .warnings()
            .iter()
            .map(|warning| (warning.code.as_str(), warning.count))
            .collect();
        assert_eq!(found, warnings, "{name}");
    }
}
