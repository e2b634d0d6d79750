//! Prints the feature edges of a view without a GPU: the class and both ends of each edge, in
//! pixels from the middle of the picture, y up. Hidden edges are included, except those that their
//! own solid hides.
//!
//! ```sh
//! cargo run -p edgemesh --example edges_of_a_view -- part.obj
//! ```

use std::error::Error;

use edgemesh::view::{LineBits, classify_edges, count_features, to_pixels};
use edgemesh::{BuildOptions, Camera, LineClass, build_edge_mesh, read_model};
use glam::{Vec2, Vec3};

const PICTURE_PX: Vec2 = Vec2::splat(1024.0);

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("use edges_of_a_view MODEL")?;
    let (model, mut report) = read_model(path.as_ref())?;
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
    let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);

    let pixel = |vertex: u32| {
        let position = Vec3::from(mesh.positions[vertex as usize]);
        to_pixels(view.clip_from_world * position.extend(1.0), PICTURE_PX)
    };
    for (record, bits) in mesh.records.iter().zip(classify_edges(&mesh, view.eye)) {
        if bits.contains(LineBits::DRAWN) {
            let is_contour = bits.contains(LineBits::CONTOUR);
            let class = LineClass::ALL.into_iter().find(|class| match class {
                LineClass::Contour => is_contour,
                _ => record.flags().intersects(class.drawn_by()),
            });
            let [from, to] = [record.v0, record.v1].map(pixel);
            println!("{:<10} {from:.1} to {to:.1}", class.map_or("", LineClass::name));
        }
    }
    let counts = count_features(&mesh, view.eye);
    for class in LineClass::ALL {
        eprintln!("{}: {}", class.name(), counts[class]);
    }
    Ok(())
}
