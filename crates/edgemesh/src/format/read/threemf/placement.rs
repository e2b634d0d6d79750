//! Places the items of the build, and the components of their objects.
//!
//! ```text
//! item, T0 --> object with components --T1--> mesh          placed by T0 T1
//!                                     '-T2--> components --T3--> mesh    by T0 T2 T3
//! ```
//!
//! A few objects of components, each with two of the next, place more triangles than
//! any memory holds. So the elements of each object are counted first, once, and
//! nothing is placed if they are too many. The functions do not recurse, because
//! a chain of objects can be long.

use std::collections::{HashMap, HashSet};

use glam::{DAffine3, DVec3};

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::model_part::{Content, Mesh, Object, Property, PropertyGroup, Reference};
use super::package::{ObjectIndex, Package};
use super::xml::place_of;
use crate::index::{MAX_INDEX, NONE, to_u32};
use crate::model::{Attributes, Corner, Material, Model, Smoothing};
use crate::report::{Place, Report, WarningCode};

/// How many vertices, triangles and components may be placed beyond one for each byte of
/// the unpacked parts: about 2 GiB, more than a printer's plate holds. Only a file that
/// uses its objects many times reaches the limit.
const REPEATED_ELEMENTS: u64 = 1 << 26;

/// The model of all items.
///
/// # Errors
/// Cycle: an object contains itself. Size: too many elements.
pub(super) fn place_items(
    source: &Source,
    package: &Package,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let roots = roots(package, report);
    check_size(source, package, &roots)?;
    let mut builder = Builder {
        package,
        report,
        model: Model::default(),
        properties: HashMap::new(),
        materials: HashMap::new(),
    };
    for root in roots {
        builder.add(root);
    }
    Ok(builder.model)
}

/// An object with the transform that places it.
#[derive(Debug, Clone, Copy)]
struct Placed<'p> {
    object: ObjectIndex,
    model_from_object: DAffine3,
    /// The name of the innermost object around it that has one.
    name: &'p str,
}

/// The items of the build; if there are none, the objects that are no components.
fn roots<'p>(package: &'p Package, report: &mut Report) -> Vec<Placed<'p>> {
    let origin = DAffine3::IDENTITY;
    let items = package.parts.first().map(|part| &part.items).into_iter().flatten();
    let placed: Vec<Placed> =
        items.filter_map(|item| placed(package, 0, item, origin, "")).collect();
    if !placed.is_empty() {
        return placed;
    }
    report.warn(WarningCode::Syntax, None, || {
        "the build is empty; all objects that are no components are drawn".into()
    });
    let all = (0..)
        .zip(&package.parts)
        .flat_map(|(part, one)| (0..one.objects.len()).map(move |object| (part, object)));
    let children: HashSet<ObjectIndex> = all
        .clone()
        .flat_map(|object| components(package, object))
        .filter_map(|(part, component)| package.target(part, component))
        .collect();
    let roots = all.filter(|object| !children.contains(object));
    roots.map(|object| Placed { object, model_from_object: origin, name: "" }).collect()
}

/// What a reference in the part `part` places, in an object that `outer` places.
fn placed<'p>(
    package: &'p Package,
    part: usize,
    reference: &Reference,
    outer: DAffine3,
    name: &'p str,
) -> Option<Placed<'p>> {
    let object = package.target(part, reference)?;
    let mut model_from_object = outer * reference.transform;
    let [unit, outer_unit] =
        [object.0, part].map(|part| package.parts.get(part).map_or(1.0, |part| part.unit));
    if unit != outer_unit {
        model_from_object *= DAffine3::from_scale(DVec3::splat(unit / outer_unit));
    }
    Some(Placed { object, model_from_object, name })
}

/// The components of an object that is drawn, with the index of its part.
fn components(
    package: &Package,
    index: ObjectIndex,
) -> impl DoubleEndedIterator<Item = (usize, &Reference)> {
    let components = package.object(index).map_or(&[][..], |object| match &object.content {
        Content::Components(components) if object.other_kind.is_none() => components,
        _ => &[],
    });
    components.iter().map(move |component| (index.0, component))
}

/// What an object places, with its components.
#[derive(Debug, Clone, Copy, Default)]
struct Size {
    triangles: u64,
    /// Triangles, vertices and components.
    elements: u64,
}

impl Size {
    fn add(&mut self, other: Self) {
        self.triangles = self.triangles.saturating_add(other.triangles);
        self.elements = self.elements.saturating_add(other.elements);
    }
}

/// Counts what the items place, before they are placed.
fn check_size(source: &Source, package: &Package, roots: &[Placed]) -> Result<(), ReadError> {
    let mut sizes = HashMap::new();
    let mut sum = Size::default();
    for root in roots {
        add_sizes(source, package, root.object, &mut sizes)?;
        sum.add(sizes.get(&root.object).copied().unwrap_or_default());
    }
    let limit = package.bytes.saturating_add(REPEATED_ELEMENTS).min(MAX_INDEX as u64 / 3);
    if sum.elements <= limit {
        return Ok(());
    }
    let what = format!(
        "too large: the build places {} triangles, with their vertices and components {} \
         elements; the limit is {limit}: split the build",
        sum.triangles, sum.elements
    );
    Err(source.error(ReadErrorKind::Size, None, what))
}

/// Adds the sizes of an object and of all below it to `sizes`.
fn add_sizes(
    source: &Source,
    package: &Package,
    root: ObjectIndex,
    sizes: &mut HashMap<ObjectIndex, Size>,
) -> Result<(), ReadError> {
    let mut open = HashSet::new();
    let mut waiting = vec![root];
    while let Some(&index) = waiting.last() {
        if sizes.contains_key(&index) {
            waiting.pop();
            continue;
        }
        let children = || {
            let targets = components(package, index);
            targets.filter_map(|(part, component)| package.target(part, component))
        };
        if open.insert(index) {
            // The children come first, and this object is looked at again behind them.
            let missing = children().filter(|child| !sizes.contains_key(child));
            for child in missing {
                if open.contains(&child) {
                    return Err(cycle(source, package, child));
                }
                waiting.push(child);
            }
            continue;
        }
        let mut size = own_size(package, index);
        for child in children() {
            size.add(sizes.get(&child).copied().unwrap_or_default());
        }
        sizes.insert(index, size);
        waiting.pop();
    }
    Ok(())
}

fn own_size(package: &Package, index: ObjectIndex) -> Size {
    let mut size = Size { triangles: 0, elements: 1 };
    if let Some(Object { content: Content::Mesh(mesh), other_kind: None, .. }) =
        package.object(index)
    {
        let [triangles, vertices] = [mesh.triangles.len(), mesh.positions.len()].map(|n| n as u64);
        size.add(Size { triangles, elements: triangles + vertices });
    }
    size
}

fn cycle(source: &Source, package: &Package, index: ObjectIndex) -> ReadError {
    let part = package.parts.get(index.0);
    let place =
        part.zip(package.object(index)).map(|(part, object)| place_of(&part.name, object.line));
    source.error(ReadErrorKind::Cycle, place, "the object is a component of itself")
}

struct Builder<'p, 'r> {
    package: &'p Package,
    report: &'r mut Report,
    model: Model,
    /// The index in the model of each used property of a part, or [`NONE`].
    properties: HashMap<(usize, Property), u32>,
    /// The index in the model of each material.
    materials: HashMap<MaterialKey<'p>, u32>,
}

/// Materials with the same name, color and opacity are one.
type MaterialKey<'p> = (&'p str, Option<[u32; 3]>, Option<u32>);

fn material_key(material: &Material) -> MaterialKey<'_> {
    let color = material.diffuse.map(|color| color.map(f32::to_bits));
    (&material.name, color, material.opacity.map(f32::to_bits))
}

impl<'p> Builder<'p, '_> {
    /// Adds an object and all below it.
    fn add(&mut self, root: Placed<'p>) {
        let mut waiting = vec![root];
        while let Some(Placed { object: index, model_from_object, name }) = waiting.pop() {
            let Some(object) = self.package.object(index) else { continue };
            if let Some(kind) = &object.other_kind {
                self.report.warn(WarningCode::Unsupported, self.place(index), || {
                    format!("an object of type '{kind}' is not part of the model; it was left out")
                });
                continue;
            }
            let name = if object.name.is_empty() { name } else { &object.name };
            let first = waiting.len();
            match &object.content {
                Content::Mesh(mesh) => self.add_mesh(index, object, mesh, model_from_object, name),
                Content::Components(components) => {
                    waiting.extend(components.iter().filter_map(|component| {
                        placed(self.package, index.0, component, model_from_object, name)
                    }))
                }
            }
            // The last one is taken first.
            waiting[first..].reverse();
        }
    }

    fn add_mesh(
        &mut self,
        index: ObjectIndex,
        object: &Object,
        mesh: &Mesh,
        model_from_object: DAffine3,
        name: &str,
    ) {
        let group = to_u32(self.model.groups.len());
        self.model.groups.push(match name {
            "" => format!("object {}", object.id),
            name => name.to_owned(),
        });
        let first = to_u32(self.model.positions.len());
        let moved = |position: &[f64; 3]| {
            model_from_object.transform_point3(DVec3::from_array(*position)).to_array()
        };
        self.model.positions.extend(mesh.positions.iter().map(moved));
        let is_mirrored = model_from_object.matrix3.determinant() < 0.0;
        let mut runs = mesh.runs.iter().peekable();
        self.begin_run(index, object, object.property, group);
        for (at, &[a, b, c]) in mesh.triangles.iter().enumerate() {
            if let Some(run) = runs.next_if(|run| run.first == at) {
                self.begin_run(index, object, run.property.or(object.property), group);
            }
            let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
            self.model.push_polygon(&corners.map(|corner| Corner::at(first + corner)), 0);
        }
    }

    /// Sets the attributes of the next triangles.
    fn begin_run(
        &mut self,
        index: ObjectIndex,
        object: &Object,
        property: Option<Property>,
        group: u32,
    ) {
        let material = property.map_or(NONE, |property| self.material(index, object, property));
        let smoothing = Smoothing::Unstated;
        self.model.set_attributes(Attributes { material, group, smoothing });
    }

    /// The index in the model of a property's material, or [`NONE`] if it has none.
    fn material(&mut self, index: ObjectIndex, object: &Object, property: Property) -> u32 {
        if let Some(&known) = self.properties.get(&(index.0, property)) {
            return known;
        }
        let group =
            self.package.parts.get(index.0).and_then(|part| part.groups.get(&property.group));
        let found = match group {
            Some(PropertyGroup::Materials(materials)) => materials.get(property.index as usize),
            _ => None,
        };
        let in_model = match found {
            Some(material) => *self.materials.entry(material_key(material)).or_insert_with(|| {
                self.model.materials.push(material.clone());
                to_u32(self.model.materials.len() - 1)
            }),
            None => {
                self.warn_of_property(index, object, property, group);
                NONE
            }
        };
        self.properties.insert((index.0, property), in_model);
        in_model
    }

    fn warn_of_property(
        &mut self,
        index: ObjectIndex,
        object: &Object,
        property: Property,
        group: Option<&PropertyGroup>,
    ) {
        let Property { group: id, index: element } = property;
        let place = self.place(index);
        match group {
            Some(PropertyGroup::Unsupported(kind)) => {
                self.report.warn(WarningCode::Unsupported, place, || {
                    format!("'{kind}' {id} is not supported; its triangles have no material")
                });
            }
            _ => self.report.warn(WarningCode::Material, place, || {
                let object = object.id;
                format!(
                    "object {object} names material {element} of group {id}, which is not there"
                )
            }),
        }
    }

    fn place(&self, index: ObjectIndex) -> Option<Place> {
        let part = self.package.parts.get(index.0)?;
        Some(place_of(&part.name, self.package.object(index)?.line))
    }
}
