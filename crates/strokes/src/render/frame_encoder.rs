//! The passes of a frame that draw: the fill, the coverage of linked strokes, and all strokes in
//! order.

use std::sync::Arc;

use edgemesh::index::to_u32;
use edgemesh::line::LineKind;

use crate::draw::coverage::CHANNELS;
use crate::draw::fill::{FillKind, FillPipeline};
use crate::draw::silhouette::{NO_OBJECT, StencilValues};
use crate::draw::stroke_indices::IndexKey;
use crate::draw::targets::Targets;
use crate::gpu::timer::TimedPasses;
use crate::graph::buffers::arguments::RIBBON_DRAWS;
use crate::mesh::geometry::EdgeGeometry;
use crate::render::drawing::{DrawnChunk, DrawnObject};
use crate::render::frame_request::{Fill, PASS_NAMES};
use crate::render::pipelines::Pipelines;
use crate::render::prepared_style::{PreparedStrokes, StrokeVertices};
use crate::style::drawing_style::Visibility;
use crate::view::live_lists::{DrawArguments, REST_OFFSET};
use crate::view::view_state::{ObjectState, ScreenBox};

/// An object with its state in the view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) object: &'a DrawnObject,
    pub(crate) state: &'a ObjectState,
}

/// The passes of a frame that draw.
pub(crate) struct FrameEncoder<'a> {
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) targets: &'a Targets,
    /// `@group(0)`.
    pub(crate) frame: &'a wgpu::BindGroup,
    pub(crate) objects: &'a [Placed<'a>],
    /// The frame with the fill, if a draw reads it.
    pub(crate) frame_fill: Option<wgpu::BindGroup>,
    /// The frame with the fill of the whole picture, if a tile is drawn.
    pub(crate) overview_fill: Option<wgpu::BindGroup>,
    pub(crate) steps: Vec<DrawStep>,
    /// Whether samples are averaged to the picture at the end.
    pub(crate) resolves: bool,
    /// Whether there are clip planes.
    pub(crate) clips: bool,
}

/// Strokes that are drawn at once.
pub(crate) enum DrawStep {
    /// One stroke set of an object, edge by edge.
    Edges { object: usize, set: usize },
    /// Linked strokes of up to four stroke sets, each of all objects in its style.
    Linked(Vec<LinkedStrokes>),
}

pub(crate) struct LinkedStrokes {
    objects: Vec<usize>,
    set: usize,
}

impl DrawStep {
    /// The steps of a frame in order, without silhouettes that are drawn edge by edge: those
    /// need the stencil.
    pub(crate) fn plan(objects: &[Placed]) -> Vec<Self> {
        let mut steps: Vec<Self> = Vec::new();
        for visibility in [Visibility::Hidden, Visibility::Visible, Visibility::Silhouette] {
            for (object, placed) in objects.iter().enumerate() {
                let sets = placed.object.style.sets.iter().enumerate();
                for (set, prepared) in sets.filter(|(_, set)| set.visibility == visibility) {
                    if prepared.is_linked {
                        Self::add_linked(&mut steps, objects, object, set);
                    } else if visibility != Visibility::Silhouette {
                        steps.push(Self::Edges { object, set });
                    }
                }
            }
        }
        steps
    }

    /// Objects in the same style share a channel, so that a scene needs as many channels as it
    /// has styles.
    fn add_linked(steps: &mut Vec<Self>, objects: &[Placed], object: usize, set: usize) {
        let is_same = |linked: &LinkedStrokes| {
            let style = &objects[linked.objects[0]].object.style;
            linked.set == set && Arc::ptr_eq(style, &objects[object].object.style)
        };
        let linked = steps.iter_mut().filter_map(|step| match step {
            Self::Linked(sets) => Some(sets),
            Self::Edges { .. } => None,
        });
        if let Some(same) = linked.flatten().find(|linked| is_same(linked)) {
            same.objects.push(object);
            return;
        }
        let new = LinkedStrokes { objects: vec![object], set };
        match steps.last_mut() {
            Some(Self::Linked(sets)) if sets.len() < CHANNELS => sets.push(new),
            _ => steps.push(Self::Linked(vec![new])),
        }
    }
}

/// The stencil values of the objects, in batches between two clears of the stencil.
pub(crate) struct StencilBatches {
    /// One per object; [`NO_OBJECT`] for those without a silhouette.
    values: Vec<u32>,
    /// The first object of each batch after the first batch.
    clears: Vec<usize>,
}

impl StencilBatches {
    /// The objects of each batch, as ranges.
    fn ranges(&self) -> Vec<std::ops::Range<usize>> {
        let starts = std::iter::once(0).chain(self.clears.iter().copied());
        let ends = self.clears.iter().copied().chain([self.values.len()]);
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }
}

impl FrameEncoder<'_> {
    pub(crate) fn stencil_values(&self) -> StencilBatches {
        let mut counter = StencilValues::default();
        let mut batches = StencilBatches { values: Vec::new(), clears: Vec::new() };
        for (index, object) in self.objects.iter().enumerate() {
            if !object.object.style.has_silhouette() {
                batches.values.push(NO_OBJECT);
                continue;
            }
            let (value, must_clear) = counter.next();
            batches.values.push(value);
            if must_clear {
                batches.clears.push(index);
            }
        }
        batches
    }

    pub(crate) fn encode_fill(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        fill: Fill,
        batches: &StencilBatches,
        timer: Option<TimedPasses>,
    ) {
        let load = match fill {
            Fill::Clear([r, g, b, a]) => wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
            Fill::Depth => wgpu::LoadOp::Load,
            Fill::Done => {
                let timer = timer.map(|timer| timer.render(3));
                let first = batches.ranges()[0].clone();
                return self.encode_stencil(encoder, first, &batches.values, timer);
            }
        };
        let color = self.targets.color_attachment(load, false);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(PASS_NAMES[3]),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(self.targets.cleared_depth()),
            timestamp_writes: timer.map(|timer| timer.render(3)),
            ..Default::default()
        });
        let first_batch = batches.clears.first().copied().unwrap_or(self.objects.len());
        for (index, object) in self.objects.iter().enumerate() {
            let value = if index < first_batch { batches.values[index] } else { NO_OBJECT };
            self.fill(&mut pass, object.object, object.object.style.fill_kind, value);
        }
    }

    fn fill(&self, pass: &mut wgpu::RenderPass, object: &DrawnObject, kind: FillKind, value: u32) {
        self.pipelines.fill.set(pass, kind, self.clips);
        pass.set_bind_group(0, self.frame, &[]);
        pass.set_bind_group(1, &object.style.fill_pass, &[]);
        pass.set_bind_group(2, &object.fill, &[]);
        pass.set_stencil_reference(value);
        FillPipeline::record(pass, &object.instance);
    }

    pub(crate) fn batches(&self) -> impl Iterator<Item = &[LinkedStrokes]> {
        self.steps.iter().filter_map(|step| match step {
            DrawStep::Linked(sets) => Some(&sets[..]),
            DrawStep::Edges { .. } => None,
        })
    }

    /// Encodes the way from chains to ribbons, by the depth of the fill.
    pub(crate) fn encode_paths(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timer: Option<TimedPasses>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[4]),
            timestamp_writes: timer.map(|timer| timer.compute(4)),
        });
        let frame = self.overview_fill.as_ref().or(self.frame_fill.as_ref());
        let Some((frame, pipelines)) = frame.zip(self.pipelines.graph.as_ref()) else {
            return;
        };
        pass.set_bind_group(0, frame, &[]);
        for object in self.objects.iter().map(|placed| placed.object) {
            if let Some((graph, styles)) =
                object.graph.as_ref().zip(object.style.link_pass.as_ref())
            {
                pass.set_bind_group(1, styles, &[]);
                pipelines.path.record(&mut pass, &graph.buffers, &graph.path);
            }
        }
    }

    /// Encodes the coverage of linked strokes, one texture per batch.
    pub(crate) fn encode_coverage(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        textures: &[wgpu::TextureView],
        timer: Option<TimedPasses>,
    ) {
        if textures.is_empty() {
            // The timer expects every pass.
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(PASS_NAMES[5]),
                timestamp_writes: timer.map(|timer| timer.compute(5)),
            });
        }
        let Some((pipelines, frame)) = self.pipelines.graph.as_ref().zip(self.frame_fill.as_ref())
        else {
            return;
        };
        for (batch, (sets, texture)) in self.batches().zip(textures).enumerate() {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(PASS_NAMES[5]),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: texture,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                timestamp_writes: timer.filter(|_| batch == 0).map(|timer| timer.render(5)),
                ..Default::default()
            });
            pass.set_bind_group(0, frame, &[]);
            self.pipelines.set_indices(&mut pass, IndexKey::Quads);
            for (channel, linked) in sets.iter().enumerate() {
                for object in linked.objects.iter().map(|&object| self.objects[object].object) {
                    let Some(graph) = &object.graph else { continue };
                    let set = &object.style.sets[linked.set];
                    pipelines.coverage.set_ribbons(&mut pass, channel, set.is_textured);
                    pass.set_bind_group(1, &set.style, &[]);
                    pass.set_bind_group(3, &graph.ribbons, &[]);
                    let at = 4 * u64::from(RIBBON_DRAWS + 5 * to_u32(linked.set));
                    pass.draw_indexed_indirect(&graph.buffers.arguments, at);
                }
            }
        }
    }

    /// The bind groups that lay each batch of coverage over the picture.
    pub(crate) fn composite_groups(
        &self,
        device: &wgpu::Device,
        textures: &[wgpu::TextureView],
    ) -> Vec<wgpu::BindGroup> {
        let Some(pipelines) = &self.pipelines.graph else { return Vec::new() };
        let group = |(sets, texture): (&[LinkedStrokes], &wgpu::TextureView)| {
            let mut colors = [[0.0; 4]; CHANNELS];
            for (color, linked) in colors.iter_mut().zip(sets) {
                *color = self.objects[linked.objects[0]].object.style.sets[linked.set].color;
            }
            pipelines.coverage.composite_group(device, colors, texture)
        };
        self.batches().zip(textures).map(group).collect()
    }

    /// The part of the picture that linked strokes can touch: left, top, width, height.
    fn touched(&self, sets: &[LinkedStrokes]) -> [u32; 4] {
        let size = self.targets.size;
        let everything = [0, 0, size[0], size[1]];
        let mut touched: Option<ScreenBox> = None;
        let mut reach_px: f32 = 0.0;
        for linked in sets {
            for &object in &linked.objects {
                let Placed { object, state } = self.objects[object];
                let reach = object.style.sets[linked.set].reach_px;
                let Some((seen, reach)) = state.screen_box().zip(reach) else { return everything };
                reach_px = reach_px.max(reach);
                touched = Some(touched.map_or(seen, |touched| touched.union(&seen)));
            }
        }
        touched.map_or(everything, |touched| touched.pixels(reach_px, size))
    }

    /// Draws the steps in order.
    fn draw_steps(&self, pass: &mut wgpu::RenderPass, laid: &[wgpu::BindGroup], values: &[u32]) {
        let mut laid = laid.iter();
        for step in &self.steps {
            match step {
                DrawStep::Edges { object, set } => {
                    self.strokes(pass, self.objects[*object].object, *set)
                }
                DrawStep::Linked(sets) => {
                    let pipelines = self.pipelines.graph.as_ref();
                    let [left, top, width, height] = self.touched(sets);
                    let composite = pipelines.zip(laid.next());
                    // Objects beside the picture do not touch it.
                    if let Some((pipelines, group)) = composite.filter(|_| width * height > 0) {
                        pass.set_scissor_rect(left, top, width, height);
                        pipelines.coverage.record_composite(pass, group, sets.len());
                        let [width, height] = self.targets.size;
                        pass.set_scissor_rect(0, 0, width, height);
                    }
                    // Edges that were not linked for lack of room.
                    for linked in sets {
                        for &object in &linked.objects {
                            pass.set_stencil_reference(values[object]);
                            self.strokes(pass, self.objects[object].object, linked.set);
                        }
                    }
                }
            }
        }
    }

    pub(crate) fn encode_strokes(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        batches: &StencilBatches,
        laid: &[wgpu::BindGroup],
        timer: Option<TimedPasses>,
    ) {
        let ranges = batches.ranges();
        for (batch, range) in ranges.iter().enumerate() {
            let is_first = batch == 0;
            if !is_first {
                self.encode_stencil(encoder, range.clone(), &batches.values, None);
            }
            let is_last = batch + 1 == ranges.len();
            let color = self.targets.color_attachment(wgpu::LoadOp::Load, is_last && self.resolves);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(PASS_NAMES[6]),
                color_attachments: &[Some(color)],
                depth_stencil_attachment: Some(self.targets.read_depth()),
                timestamp_writes: timer.filter(|_| is_first).map(|timer| timer.render(6)),
                ..Default::default()
            });
            if is_first {
                self.draw_steps(&mut pass, laid, &batches.values);
            }
            for index in range.clone().filter(|&index| batches.values[index] != NO_OBJECT) {
                pass.set_stencil_reference(batches.values[index]);
                let object = self.objects[index].object;
                for (set, prepared) in object.style.sets.iter().enumerate() {
                    if prepared.visibility == Visibility::Silhouette && !prepared.is_linked {
                        self.strokes(&mut pass, object, set);
                    }
                }
            }
        }
    }

    /// Clears the stencil and writes the values of a batch of objects where they are the
    /// nearest.
    fn encode_stencil(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        range: std::ops::Range<usize>,
        values: &[u32],
        timer: Option<wgpu::RenderPassTimestampWrites>,
    ) {
        let color = self.targets.color_attachment(wgpu::LoadOp::Load, false);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("stencil"),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(self.targets.cleared_stencil()),
            timestamp_writes: timer,
            ..Default::default()
        });
        for index in range.filter(|&index| values[index] != NO_OBJECT) {
            self.fill(&mut pass, self.objects[index].object, FillKind::Stencil, values[index]);
        }
    }

    /// Draws one stroke set of an object, edge by edge.
    fn strokes(&self, pass: &mut wgpu::RenderPass, object: &DrawnObject, index: usize) {
        let Some(set) = object.style.sets.get(index) else { return };
        let with_fill = self.frame_fill.as_ref().filter(|_| set.reads_fill);
        pass.set_bind_group(0, with_fill.unwrap_or(self.frame), &[]);
        pass.set_bind_group(1, &set.style, &[]);
        let sizes = object.instance.mesh().chunks.iter().map(|chunk| chunk.size);
        let geometries = &object.instance.geometry().chunks;
        for ((chunk, size), geometry) in object.chunks.iter().zip(sizes).zip(geometries) {
            match (&set.vertices, &geometry.edges) {
                (StrokeVertices::Lists { expanded, listed }, _) => {
                    let expanded = expanded.as_ref().map(|(_, pipeline)| pipeline);
                    self.listed_strokes(pass, chunk, set, index, expanded, listed);
                }
                (StrokeVertices::All(pipeline), _) => {
                    let index_count = to_u32(set.kind.indices().len());
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(2, &chunk.edges, &[]);
                    pass.set_bind_group(3, chunk.planes.as_ref(), &[]);
                    pass.draw(0..index_count * size.edge_count, 0..1);
                }
                (StrokeVertices::Attributes(pipeline), EdgeGeometry::Replicated { vertices }) => {
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(2, &chunk.edges, &[]);
                    pass.set_vertex_buffer(0, vertices.slice(..));
                    self.attribute_strokes(pass, set.kind, size.edge_count);
                }
                // Only replicated vertices have attributes.
                (StrokeVertices::Attributes(_), EdgeGeometry::Indexed { .. }) => {}
            }
        }
    }

    /// Draws the expanded strokes, then the rest of the list.
    fn listed_strokes(
        &self,
        pass: &mut wgpu::RenderPass,
        chunk: &DrawnChunk,
        set: &PreparedStrokes,
        index: usize,
        expanded: Option<&wgpu::RenderPipeline>,
        listed: &wgpu::RenderPipeline,
    ) {
        let Some(bound) = &chunk.lists else { return };
        let arguments = (index * size_of::<DrawArguments>()) as u64;
        if let (Some(expanded), Some(vertices)) = (expanded, &bound.lists.vertices[index]) {
            pass.set_pipeline(expanded);
            pass.set_vertex_buffer(0, vertices.slice(..));
            self.pipelines.set_indices(pass, IndexKey::Expanded(set.kind));
            pass.draw_indexed_indirect(&bound.lists.arguments, arguments);
        }
        pass.set_pipeline(listed);
        pass.set_bind_group(2, &chunk.edges, &[]);
        pass.set_bind_group(3, &bound.listed, &[]);
        pass.draw_indirect(&bound.lists.arguments, arguments + REST_OFFSET);
    }

    /// Draws the paper's passes: all quads, then all ends, one triangle of each at a time.
    fn attribute_strokes(&self, pass: &mut wgpu::RenderPass, kind: LineKind, edge_count: u32) {
        let key = if kind == LineKind::Thin { IndexKey::Lines } else { IndexKey::Quads };
        let per_edge = to_u32(key.pattern().0.len());
        self.pipelines.set_indices(pass, key);
        pass.draw_indexed(0..per_edge * edge_count, 0, 0..1);
        let parts = to_u32(kind.indices().len() / 3).saturating_sub(2);
        if parts > 0 {
            self.pipelines.set_indices(pass, IndexKey::Ends);
            pass.draw_indexed(0..3 * edge_count, 0, 1..1 + parts);
        }
    }
}
