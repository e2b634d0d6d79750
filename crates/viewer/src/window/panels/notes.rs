//! Messages above the picture.

use egui::{Align2, Area, Frame, Order, RichText, ScrollArea, Ui};

use crate::window::session::{Request, Session, Work};

/// Progress, notes and mistakes, at the lower left of the picture at `rect`.
pub fn notes(ui: &Ui, session: &mut Session, rect: egui::Rect) {
    let width = (rect.width() - 32.0).clamp(160.0, 720.0);
    Area::new(egui::Id::unique("notes"))
        .order(Order::Foreground)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(rect.left_bottom() + egui::vec2(16.0, -16.0))
        .show(ui.ctx(), |ui| {
            ui.set_max_width(width);
            let (texts, next) = session.messages.notes();
            for text in texts {
                card(ui, |ui| drop(ui.label(text)));
            }
            if let Some(next) = next {
                ui.ctx().request_repaint_after(next);
            }
            work(ui, session);
            technique_mistake(ui, session, rect.height() * 0.5);
            errors(ui, session);
        });
}

fn card(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    Frame::popup(ui.style()).show(ui, contents);
}

fn work(ui: &mut Ui, session: &mut Session) {
    for Work { what, since, saving } in session.work.clone() {
        card(ui, |ui| {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label(format!("{what} ({:.1} s)", since.elapsed().as_secs_f32()));
                if ui.button("Cancel").clicked() {
                    session.ask(Request::Cancel(saving));
                }
            });
        });
    }
}

fn technique_mistake(ui: &mut Ui, session: &mut Session, height: f32) {
    let Some(text) = session.messages.technique.clone() else { return };
    card(ui, |ui| {
        let color = ui.visuals().error_fg_color;
        ui.label(
            RichText::new("The technique cannot be drawn; the last good one is shown").color(color),
        );
        ScrollArea::both().max_height(height).show(ui, |ui| {
            ui.label(RichText::new(text).monospace());
        });
        if ui.button("Dismiss").clicked() {
            session.messages.technique = None;
        }
    });
}

fn errors(ui: &mut Ui, session: &mut Session) {
    let mut read = None;
    for (at, text) in session.messages.errors.iter().enumerate() {
        card(ui, |ui| {
            let color = ui.visuals().error_fg_color;
            ui.label(RichText::new(text).color(color));
            ui.push_id(at, |ui| {
                if ui.button("Dismiss").clicked() {
                    read = Some(at);
                }
            });
        });
    }
    if let Some(at) = read {
        session.messages.errors.remove(at);
    }
}
