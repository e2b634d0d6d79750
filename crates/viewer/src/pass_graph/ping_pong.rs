//! `ping_pong`: runs a program over a texture, then several times over its own output
//! (Card and Mitchell, *Thickening Outlines with Morphology*).
//!
//! ```text
//!   texture --run 0--> a --run 1--> b --run 2--> a ... --last run--> target
//! ```

use strokes::TimedPasses;

use super::Encoding;
use super::bindings::{Replacement, Sources};
use super::builder::Builder;
use super::params::Iteration;
use super::pipeline::{DepthUse, GroupBuffers, PassPipeline, PipelineTarget};
use super::screen_pass::{color_attachment, draw, own_program, screen_pipeline};
use super::textures::target_texture;
use crate::error::Error;
use crate::technique::core_view;
use crate::technique::pass::Pass;
use crate::technique::plan::PassPlan;
use crate::technique::program::ProgramKind;
use crate::technique::texture_format::TextureSize;

/// Runs a program several times.
#[derive(Debug)]
pub(crate) struct PingPong {
    /// Draws to the temporary textures.
    between: PassPipeline,
    /// Draws to the target.
    last: PassPipeline,
    temporary: [wgpu::TextureView; 2],
    /// The size of the temporary textures.
    size: TextureSize,
    /// The format of the temporary textures.
    format: wgpu::TextureFormat,
    /// The parameters of each run.
    buffers: Vec<GroupBuffers>,
    count: usize,
}

impl PingPong {
    pub(crate) fn new(
        builder: &Builder,
        pass: &Pass,
        plan: &PassPlan,
        view: &core_view::PingPong,
    ) -> Result<Self, Error> {
        let target = builder.target(plan);
        let options = builder.input.options;
        let (size, format) = (view.target.size, target.colors[0]);
        let temporary = temporary(&builder.gpu.device, size.pixels(options.size), format);
        let offscreen = PipelineTarget {
            colors: vec![format],
            depth: None,
            samples: 1,
            blend: None,
            is_pushed: false,
            writes_depth: false,
            depth_use: DepthUse::Nearest,
            clips: options.clips,
        };
        let count = view.run_count;
        let fragment = plan.programs.fragment.as_ref();
        let between = screen_pipeline(builder, pass, plan, fragment, &offscreen)?;
        let last = match count {
            // Without a run the input is copied to the target.
            0 => {
                let copy = own_program("copy:copy", ProgramKind::Fragment)?;
                screen_pipeline(builder, pass, plan, Some(&copy), &target)?
            }
            _ => screen_pipeline(builder, pass, plan, fragment, &target)?,
        };
        let device = &builder.gpu.device;
        let buffers = (0..count.max(1)).map(|index| {
            let number = |number: usize| i32::try_from(number).unwrap_or(i32::MAX);
            let iteration = Iteration { index: number(index), count: number(count) };
            let pipeline = if index + 1 >= count { &last } else { &between };
            pipeline.buffers(device, pass, iteration)
        });
        let buffers = buffers.collect();
        Ok(Self { between, last, temporary, size, format, buffers, count })
    }

    /// Makes the temporary textures for another size of the picture.
    pub(crate) fn resize(&mut self, device: &wgpu::Device, picture: [u32; 2]) {
        self.temporary = temporary(device, self.size.pixels(picture), self.format);
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        plan: &PassPlan,
        sources: &mut Sources,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        let runs = self.count.max(1);
        let first_of_several = timer.filter(|_| runs > 1).map(|timer| timer.render(0));
        let mut timestamps = first_of_several;
        for index in 0..runs {
            let is_last = index + 1 == runs;
            let pipeline = if is_last { &self.last } else { &self.between };
            let before = index.checked_sub(1).map(|before| &self.temporary[before % 2]);
            let variable = core_view::PingPong::INPUT;
            let input = before.map(|view| Replacement { variable, view });
            let groups = pipeline.bind(encoding.gpu, &self.buffers[index], sources, input)?;
            if is_last {
                let timestamps = match runs {
                    1 => timer.map(|timer| timer.render(0)),
                    _ => None,
                };
                draw(encoder, encoding, plan, sources, pipeline, &groups, timestamps);
            } else {
                let view = &self.temporary[index % 2];
                let load = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("ping pong"),
                    color_attachments: &[Some(color_attachment(view, load))],
                    timestamp_writes: timestamps.take(),
                    ..Default::default()
                });
                pass.set_pipeline(&pipeline.pipeline);
                pass.set_bind_group(0, encoding.view.frame_group(), &[]);
                for (index, group) in &groups {
                    pass.set_bind_group(*index, group, &[]);
                }
                pass.draw(0..3, 0..1);
            }
        }
        Ok(())
    }
}

fn temporary(
    device: &wgpu::Device,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> [wgpu::TextureView; 2] {
    [0, 1].map(|_| {
        let texture = target_texture(device, "ping pong", size, format);
        texture.create_view(&Default::default())
    })
}
