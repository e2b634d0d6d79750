//! Edge mesh files of any mesh that can be built.

use edgemesh::build::BuildOptions;
use edgemesh::format::edge_mesh_file::{FileErrorKind, Layout, parse, to_bytes};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::config;
use crate::meshes::{Mesh, closed_mesh, one_sided_mesh, oriented_mesh, soup, wild_soup};

fn any_mesh() -> impl Strategy<Value = Mesh> {
    prop_oneof![closed_mesh(), oriented_mesh(), one_sided_mesh(), soup(3..=6), wild_soup()]
}

proptest! {
    #![proptest_config(config(512))]

    /// A written file gives back the mesh, its report and its name.
    #[test]
    fn files_give_back_what_was_built(mesh in any_mesh(), name in ".{0,9}") {
        let (built, report) = mesh.build_with(&BuildOptions::default());
        let bytes = to_bytes(&built, &name, &report, &Layout::ALL);
        let bytes = bytes.map_err(|error| TestCaseError::fail(error.to_string()))?;
        let stored = parse(&bytes).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(stored.to_mesh(), built);
        prop_assert_eq!((stored.name.as_ref(), stored.report()), (name.as_str(), &report));
    }

    /// A sound header alone is not a file.
    #[test]
    fn other_bytes_are_refused(count in 0..4_u32, content in vec(any::<u8>(), 0..200)) {
        let length = 56 + content.len() as u64;
        let version = 1_u32;
        let head = [
            b"EDGEMESH",
            &version.to_le_bytes()[..],
            &count.to_le_bytes(),
            &length.to_le_bytes(),
        ]
        .concat();
        let sum = blake3::hash(&[&head[..], &content].concat());
        let error = parse(&[&head[..], sum.as_bytes(), &content].concat()).unwrap_err();
        prop_assert_eq!(error.kind, FileErrorKind::Section, "{}", error);
        prop_assert!(parse(&content).is_err());
    }
}
