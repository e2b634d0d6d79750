//! `viewer adapters`: the graphics adapters and the features that each lacks.

use clap::Args;
use edgemesh::command::{Failure, print_to_stdout, to_json};
use serde::Serialize;
use strokes::{Gpu, GpuError};

use crate::error::Error;

/// Lists the graphics adapters and what each lacks
///
/// The environment variable `WGPU_BACKEND` selects the backends: vulkan, metal, dx12, gl.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  viewer adapters\n  WGPU_BACKEND=gl viewer adapters --json")]
pub(super) struct AdaptersCommand {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct AdapterEntry {
    name: String,
    backend: String,
    kind: String,
    driver: String,
    lacks: Vec<String>,
}

impl AdaptersCommand {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let (instance, backends) = Gpu::instance();
        let adapters = pollster::block_on(instance.enumerate_adapters(backends));
        let entries: Vec<AdapterEntry> = adapters
            .iter()
            .map(|adapter| {
                let info = adapter.get_info();
                AdapterEntry {
                    name: info.name,
                    backend: info.backend.to_string(),
                    kind: format!("{:?}", info.device_type),
                    driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
                    lacks: Gpu::lacking(adapter),
                }
            })
            .collect();
        if entries.is_empty() {
            let names: Vec<String> =
                backends.iter_names().map(|(name, _)| name.to_lowercase()).collect();
            return Err(Error::from(GpuError::NoAdapter { tried: names.join(", ") }).into());
        }
        let text = if self.json { to_json(&entries)? } else { to_text(&entries) };
        print_to_stdout(text.as_bytes())
    }
}

fn to_text(entries: &[AdapterEntry]) -> String {
    entries
        .iter()
        .map(|AdapterEntry { name, backend, kind, driver, lacks }| {
            let verdict = match lacks.is_empty() {
                true => "lacks nothing".to_owned(),
                false => format!("lacks {}", lacks.join(", ")),
            };
            format!("{name} ({backend}, {kind}, {driver}): {verdict}\n")
        })
        .collect()
}
