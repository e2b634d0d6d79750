//! Names in OBJ files, one to a line.

use std::collections::HashSet;

use super::one_line::one_line;
use crate::model::Material;

/// The name of the faces without a material, if others have one.
const NO_MATERIAL: &str = "none";

/// A name that neither ends its line, continues it (a backslash) nor begins a comment (a hash).
pub(super) fn statement_name(name: &str) -> String {
    one_line(name).replace(['\\', '#'], "_").trim().to_owned()
}

/// The names of materials, all different.
pub(super) struct MaterialNames(Vec<String>);

impl MaterialNames {
    /// The materials' own names, with a number where they have none or share it.
    pub(super) fn of(materials: &[Material]) -> Self {
        let mut taken = HashSet::from([NO_MATERIAL.to_owned()]);
        let unique = |(number, material): (usize, &Material)| {
            let mut name = statement_name(&material.name);
            while name.is_empty() || taken.contains(&name) {
                name = format!("{name}_{number}");
            }
            taken.insert(name.clone());
            name
        };
        Self(materials.iter().enumerate().map(unique).collect())
    }

    /// The name of a material by its index, or that of faces without one.
    pub(super) fn name(&self, material: u32) -> &str {
        self.0.get(material as usize).map_or(NO_MATERIAL, String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::NONE;

    #[test]
    fn names_are_different() {
        let named = |name: &&str| Material { name: (*name).into(), ..Material::default() };
        let materials: Vec<Material> =
            ["red", "", "red", "a#b\n", "none", "_1"].iter().map(named).collect();
        let names = MaterialNames::of(&materials);
        let all: Vec<&str> = [0, 1, 2, 3, 4, 5, NONE].map(|k| names.name(k)).into();
        assert_eq!(all, ["red", "_1", "red_2", "a_b", "none_4", "_1_5", "none"]);
    }
}
