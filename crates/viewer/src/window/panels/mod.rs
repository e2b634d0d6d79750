//! The panels beside the picture. They read and change the session, and request from the
//! window what takes more than that.
//!
//! - `bar`: above and below the picture. `look`, with `variable` and `image_preview`: the
//!   technique.
//! - `lines`, `light`, `view`, `inspect`, `output`: the other panels.
//! - `comparison`: the line between two appearances.
//! - `notes`: messages. `keys`: the sheet of keys. `no_picture`: shown before the first
//!   picture.

mod bar;
mod comparison;
mod image_preview;
mod inspect;
mod keys;
mod light;
mod lines;
mod look;
mod no_picture;
mod notes;
mod output;
mod variable;
mod view;

pub use bar::{status_bar, top_bar};
pub use comparison::comparison_line;
use egui::{ScrollArea, Ui};
pub use keys::keys_sheet;
pub use no_picture::no_picture;
pub use notes::notes;

use super::remembered::Tab;
use super::session::Session;

/// The panel at the side: its tabs and the open one. `size` is that of the picture in pixels.
pub fn side_panel(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        for (tab, name) in Tab::ALL {
            ui.selectable_value(&mut session.remembered.tab, tab, name);
        }
    });
    ui.separator();
    let tab = session.remembered.tab;
    ScrollArea::vertical().id_salt(tab as u8).auto_shrink([false, false]).show(ui, |ui| {
        match tab {
            Tab::Look => look::look_panel(ui, session),
            Tab::Lines => lines::lines_panel(ui, session),
            Tab::Light => light::light_panel(ui, session),
            Tab::View => view::view_panel(ui, session),
            Tab::Inspect => inspect::inspect_panel(ui, session),
            Tab::Output => output::output_panel(ui, session, size),
        }
        ui.add_space(12.0);
    });
}
