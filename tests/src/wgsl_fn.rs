//! Runs a WGSL function over data, for comparison with its Rust twin.

use bytemuck::Pod;
use edgemesh_shaders::ShaderSource;
use edgemesh_shaders::files::text as embedded_text;
use strokes::{Gpu, read_buffer, shader_module};
use wgpu::util::DeviceExt as _;

/// Fills the output before the shader runs, so that a result that was never written
/// differs from 0.
pub const SENTINEL: u8 = 0xff;

/// Runs `body` once for each of `inputs` and returns the outputs in order.
///
/// `body` is WGSL with imports above it; it defines `struct Input`, `struct
/// Output` and `fn run(input: Input) -> Output`, laid out as `I` and `O`.
///
/// # Panics
/// If the shader is invalid, or an output was not written.
#[must_use]
pub fn run_wgsl<I: Pod, O: Pod>(gpu: &Gpu, body: &str, inputs: &[I]) -> Vec<O> {
    let pipeline = pipeline_of(gpu, body);
    let buffer = |contents: &[u8], usage| {
        gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::STORAGE | usage,
        })
    };
    let input = buffer(bytemuck::cast_slice(inputs), wgpu::BufferUsages::empty());
    let blank = vec![SENTINEL; inputs.len() * size_of::<O>()];
    let output = buffer(&blank, wgpu::BufferUsages::COPY_SRC);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(3),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
        ],
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(3, &group, &[]);
        let groups = u32::try_from(inputs.len().div_ceil(64)).expect("few inputs");
        pass.dispatch_workgroups(groups, 1, 1);
    }
    gpu.queue.submit([encoder.finish()]);
    let outputs: Vec<O> = read_buffer(gpu, &output, inputs.len()).expect("the device answers");
    for (index, output) in outputs.iter().enumerate() {
        let is_written = bytemuck::bytes_of(output).iter().any(|&byte| byte != SENTINEL);
        assert!(is_written, "output {index} was not written");
    }
    outputs
}

fn pipeline_of(gpu: &Gpu, body: &str) -> wgpu::ComputePipeline {
    let text = format!(
        "{body}
@group(3) @binding(0) var<storage, read> inputs: array<Input>;
@group(3) @binding(1) var<storage, read_write> outputs: array<Output>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {{
    if id.x < arrayLength(&inputs) {{
        outputs[id.x] = run(inputs[id.x]);
    }}
}}
"
    );
    let load = |path: &str| match path {
        "snippet.wgsl" => Some(text.clone()),
        _ => embedded_text(path).map(str::to_owned),
    };
    let source = ShaderSource::resolve("snippet.wgsl", &load).expect("the snippet resolves");
    if let Err(error) = source.validate() {
        panic!("{error}\n{}", source.text);
    }
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &shader_module(&gpu.device, &source, "snippet"),
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}
