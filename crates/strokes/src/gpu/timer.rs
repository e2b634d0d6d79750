//! How long each pass takes on the GPU, by timestamp queries.

use wgpu::Features;

use crate::gpu::device::Gpu;
use crate::gpu::readback::{PendingRead, ReadbackError, read_buffer};

/// Measures a run of passes: two timestamps per pass.
#[derive(Debug)]
pub struct GpuTimer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    pass_count: u32,
}

impl GpuTimer {
    /// A timer for `pass_count` passes; `None` if the device has no timestamps, or cannot
    /// hold that many (0, or more than 2048).
    #[must_use]
    pub fn new(gpu: &Gpu, pass_count: u32) -> Option<Self> {
        let has_timestamps = gpu.device.features().contains(Features::TIMESTAMP_QUERY);
        let is_in_range = (1..=wgpu::QUERY_SET_MAX_QUERIES / 2).contains(&pass_count);
        if !(has_timestamps && is_in_range) {
            return None;
        }
        let count = 2 * pass_count;
        let queries = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("pass times"),
            ty: wgpu::QueryType::Timestamp,
            count,
        });
        let resolved = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pass times"),
            size: 8 * u64::from(count),
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Some(Self { queries, resolved, pass_count })
    }

    /// The passes from number `first` on.
    #[must_use]
    pub const fn passes_from(&self, first: u32) -> TimedPasses<'_> {
        TimedPasses { timer: self, first }
    }

    const fn compute(&self, index: u32) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        }
    }

    const fn render(&self, index: u32) -> wgpu::RenderPassTimestampWrites<'_> {
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        }
    }

    /// Encodes the end of the run; call it after the last pass, in the same submission.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2 * self.pass_count, &self.resolved, 0);
    }

    /// Waits for the last submission and reads its times.
    ///
    /// # Errors
    /// [`ReadbackError`], if the device is lost.
    pub fn read(&self, gpu: &Gpu) -> Result<GpuTimes, ReadbackError> {
        Ok(self.times(gpu, &read_buffer(gpu, &self.resolved, self.tick_count())?))
    }

    /// Begins to read the ticks of the last submission, for [`Self::times`].
    ///
    /// # Errors
    /// [`ReadbackError`], if the device is lost.
    pub fn begin_read(&self, gpu: &Gpu) -> Result<PendingRead<u64>, ReadbackError> {
        PendingRead::begin(gpu, &self.resolved, self.tick_count())
    }

    const fn tick_count(&self) -> usize {
        2 * self.pass_count as usize
    }

    /// Converts ticks, two per pass, to milliseconds.
    #[must_use]
    pub fn times(&self, gpu: &Gpu, ticks: &[u64]) -> GpuTimes {
        let ns_per_tick = f64::from(gpu.queue.get_timestamp_period());
        #[expect(clippy::cast_precision_loss, reason = "a frame takes far less than 2^52 ticks")]
        let ms = |start: u64, end: u64| end.saturating_sub(start) as f64 * ns_per_tick / 1e6;
        let passes_ms = ticks.as_chunks::<2>().0.iter().map(|&[start, end]| ms(start, end));
        let first = ticks.iter().min().copied().unwrap_or_default();
        let last = ticks.iter().max().copied().unwrap_or_default();
        GpuTimes { passes_ms: passes_ms.collect(), frame_ms: ms(first, last) }
    }
}

/// The passes of a timer from one of them on. Numbers must stay below the timer's count:
/// wgpu rejects other passes.
#[derive(Debug, Clone, Copy)]
pub struct TimedPasses<'a> {
    timer: &'a GpuTimer,
    first: u32,
}

impl<'a> TimedPasses<'a> {
    /// The passes from number `index` of these on.
    #[must_use]
    pub const fn from(&self, index: u32) -> Self {
        Self { timer: self.timer, first: self.first + index }
    }

    /// How many passes there are.
    pub(crate) const fn count(&self) -> u32 {
        self.timer.pass_count.saturating_sub(self.first)
    }

    /// The queries around compute pass `index`.
    #[must_use]
    pub const fn compute(&self, index: u32) -> wgpu::ComputePassTimestampWrites<'a> {
        self.timer.compute(self.first + index)
    }

    /// The queries around render pass `index`.
    #[must_use]
    pub const fn render(&self, index: u32) -> wgpu::RenderPassTimestampWrites<'a> {
        self.timer.render(self.first + index)
    }
}

/// How long a frame took on the GPU.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GpuTimes {
    /// Milliseconds of each pass.
    pub passes_ms: Vec<f64>,
    /// Milliseconds from the start of the first pass to the end of the last.
    pub frame_ms: f64,
}
