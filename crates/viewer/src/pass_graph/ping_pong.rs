//! `ping_pong`: a program over a texture, then over its own output, again and again
//! (Card and Mitchell, *Thickening Outlines with Morphology*).
//!
//! ```text
//!   texture --run 0--> a --run 1--> b --run 2--> a ... --last run--> target
//! ```

use strokes::gpu::timer::TimedPasses;

use super::Encoding;
use super::bindings::Sources;
use super::build::Builder;
use super::params::Iteration;
use super::pipeline::{GroupBuffers, PassPipeline, PipelineTarget};
use super::screen_pass::{color_attachment, draw, own_program, screen_pipeline};
use super::textures::target_texture;
use crate::error::Error;
use crate::technique::pass::Pass;
use crate::technique::plan::PassPlan;
use crate::technique::program::ProgramKind;
use crate::technique::texture_format::TextureSize;

/// The variable that every run but the first reads as the output of the one before.
const INPUT: &str = "texture";

/// A program that is run again and again.
#[derive(Debug)]
pub(crate) struct PingPong {
    /// Into the temporary textures.
    between: PassPipeline,
    /// Into the target.
    last: PassPipeline,
    temporary: [wgpu::TextureView; 2],
    /// The size and the format of those.
    kind: (TextureSize, wgpu::TextureFormat),
    /// Of each run.
    buffers: Vec<GroupBuffers>,
    count: usize,
}

impl PingPong {
    pub(crate) fn new(
        builder: &Builder,
        pass: &Pass,
        plan: &PassPlan,
        frame: &wgpu::BindGroupLayout,
    ) -> Result<Self, Error> {
        let target = builder.target(pass, plan);
        let size = [pass.int("render_target_width"), pass.int("render_target_height")];
        let size = TextureSize { sides: size, scale: pass.number("render_target_scale") };
        let format = target.colors[0];
        let kind = (size, format);
        let temporary = temporary(&builder.gpu.device, kind, builder.options.size);
        let offscreen = PipelineTarget {
            colors: vec![format],
            depth: None,
            samples: 1,
            blend: None,
            is_pushed: false,
            writes_depth: false,
            clips: builder.options.clips,
        };
        let count = usize::try_from(pass.int("pass_count")).unwrap_or(0);
        let mut copied = plan.clone();
        if count == 0 {
            // Nothing is run: the input goes to the target as it is.
            copied.fragment = Some(own_program("copy:copy", ProgramKind::Fragment)?);
        }
        let between = screen_pipeline(builder, pass, plan, frame, &offscreen)?;
        let last = screen_pipeline(builder, pass, &copied, frame, &target)?;
        let device = &builder.gpu.device;
        let buffers = (0..count.max(1)).map(|index| {
            let number = |number: usize| i32::try_from(number).unwrap_or(i32::MAX);
            let iteration = Iteration { index: number(index), count: number(count) };
            let pipeline = if index + 1 >= count { &last } else { &between };
            pipeline.buffers(device, pass, iteration)
        });
        Ok(Self { buffers: buffers.collect(), between, last, temporary, kind, count })
    }

    /// Goes on in a picture of another size.
    pub(crate) fn resize(&mut self, device: &wgpu::Device, picture: [u32; 2]) {
        self.temporary = temporary(device, self.kind, picture);
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
            let input = before.map(|view| (INPUT, view));
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
                pass.set_bind_group(0, encoding.view.frame().bind_group(), &[]);
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
    (size, format): (TextureSize, wgpu::TextureFormat),
    picture: [u32; 2],
) -> [wgpu::TextureView; 2] {
    [0, 1].map(|_| {
        let texture = target_texture(device, "ping pong", size.pixels(picture), format);
        texture.create_view(&Default::default())
    })
}
