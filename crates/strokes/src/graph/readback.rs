//! The stroke graph of a view in memory, for tests, measurements and inspection.

use crate::gpu::device::Gpu;
use crate::gpu::readback::{ReadbackError, read_buffer};
use crate::graph::buffers::{
    Element, GraphBuffers, GraphHeader, LinkNode, PathPoint, Ribbon, Stroke,
};

/// The stroke graph of one object in one view.
#[derive(Debug)]
#[non_exhaustive]
pub struct GraphReadback {
    /// The counts.
    pub header: GraphHeader,
    /// The layer of each stroke set; `None` for sets that are not linked.
    set_layers: Vec<Option<u32>>,
    /// The linked edges, layer by layer.
    pub nodes: Vec<LinkNode>,
    /// The elements of all chains, chain by chain.
    pub elements: Vec<Element>,
    /// The points of all paths, stroke set by stroke set.
    pub points: Vec<PathPoint>,
    /// The strokes of all paths.
    pub strokes: Vec<Stroke>,
    /// The segments of all paths, one per point.
    pub ribbons: Vec<Ribbon>,
}

impl GraphReadback {
    /// Reads `buffers`; waits for all submitted work.
    pub(crate) fn read(
        gpu: &Gpu,
        buffers: &GraphBuffers,
        set_layers: Vec<Option<u32>>,
    ) -> Result<Self, ReadbackError> {
        let header: GraphHeader = read_buffer(gpu, &buffers.header, 1)?[0];
        let node_count = header.node_count as usize;
        let point_count = header.point_count as usize;
        Ok(Self {
            header,
            set_layers,
            nodes: read_buffer(gpu, &buffers.nodes, node_count)?,
            elements: read_buffer(gpu, &buffers.elements, node_count)?,
            points: read_buffer(gpu, &buffers.points, point_count)?,
            ribbons: read_buffer(gpu, &buffers.ribbons, point_count)?,
            strokes: read_buffer(gpu, &buffers.strokes, header.stroke_count as usize)?,
        })
    }

    /// The stroke set that a joint belongs to.
    fn set_of(&self, joint: u32) -> usize {
        let firsts = &self.header.set_first[..self.set_layers.len()];
        firsts.iter().rposition(|first| *first <= joint).unwrap_or(0)
    }

    /// The layer of a joint; 0 if there is no such joint.
    #[must_use]
    pub fn layer_of(&self, joint: u32) -> usize {
        self.set_layers.get(self.set_of(joint)).copied().flatten().unwrap_or(0) as usize
    }

    /// The layer of a node; the last one if there is no such node.
    #[must_use]
    pub fn layer_of_node(&self, node: u32) -> usize {
        self.header.layer_first.iter().rposition(|first| *first <= node).unwrap_or(0)
    }

    /// The index of the element that begins at a joint of [`PathPoint::joint`].
    #[must_use]
    pub fn element_of(&self, joint: u32) -> usize {
        let first = self.header.set_first[self.set_of(joint)];
        (self.header.layer_first[self.layer_of(joint)] + joint - first) as usize
    }
}
