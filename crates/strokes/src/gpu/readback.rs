//! From the GPU back to memory: pictures and buffers.

use std::marker::PhantomData;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use bytemuck::Pod;
use image::RgbaImage;
use thiserror::Error;

use crate::gpu::device::Gpu;

/// A texture or buffer was not read back: it cannot be copied from, or the device was lost or
/// has no memory for the copy.
#[derive(Debug, Error)]
#[non_exhaustive]
#[error("the picture could not be read back from the graphics adapter: {reason}")]
pub struct ReadbackError {
    /// The mismatch, or the driver's message.
    pub reason: String,
}

impl ReadbackError {
    fn new(reason: impl std::fmt::Display) -> Self {
        Self { reason: reason.to_string() }
    }
}

/// Reads a texture of 8-bit RGBA and one sample per pixel, without conversion; waits for all
/// submitted work.
///
/// # Errors
/// As [`read_texels`], and if the format is another one.
pub fn read_picture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, ReadbackError> {
    let format = texture.format();
    if format.remove_srgb_suffix() != wgpu::TextureFormat::Rgba8Unorm {
        return Err(ReadbackError::new(format!(
            "a texture of {format:?} is not an 8-bit RGBA picture"
        )));
    }
    RgbaImage::from_raw(texture.width(), texture.height(), read_texels(gpu, texture)?)
        .ok_or_else(|| ReadbackError::new("it gave too few bytes"))
}

/// Reads the first mip level of a two-dimensional texture, row by row without gaps; waits for
/// all submitted work.
///
/// # Errors
/// [`ReadbackError`], if the texture has several samples or layers, has a format without bytes
/// per texel, or was made without [`COPY_SRC`](wgpu::TextureUsages::COPY_SRC); and if the
/// device is lost or has no memory for the copy.
pub fn read_texels<T: Pod>(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<T>, ReadbackError> {
    let row_bytes = bytes_per_texel(texture)? * texture.width();
    let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = staging(gpu, u64::from(padded_bytes) * u64::from(texture.height()))?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_bytes),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    let bytes = map(gpu, &buffer)?;
    let rows = bytes.chunks(padded_bytes as usize).flat_map(|row| &row[..row_bytes as usize]);
    let bytes: Vec<u8> = rows.copied().collect();
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

/// Bytes of a texel, if the texture can be copied to a buffer.
fn bytes_per_texel(texture: &wgpu::Texture) -> Result<u32, ReadbackError> {
    if texture.sample_count() > 1 {
        return Err(ReadbackError::new("the texture has several samples per pixel"));
    }
    if texture.dimension() != wgpu::TextureDimension::D2 || texture.depth_or_array_layers() > 1 {
        return Err(ReadbackError::new("the texture has several layers"));
    }
    if !texture.usage().contains(wgpu::TextureUsages::COPY_SRC) {
        return Err(ReadbackError::new("the texture was made without the usage COPY_SRC"));
    }
    let format = texture.format();
    format
        .block_copy_size(None)
        .filter(|_| format.block_dimensions() == (1, 1))
        .ok_or_else(|| ReadbackError::new(format!("{format:?} has no bytes per texel")))
}

/// Reads the first `count` items of a buffer; waits for all submitted work.
///
/// # Errors
/// [`ReadbackError`], if the buffer is shorter, or was made without
/// [`COPY_SRC`](wgpu::BufferUsages::COPY_SRC), or the items are not a multiple of 4 bytes; and
/// if the device is lost or has no memory for the copy.
pub fn read_buffer<T: Pod>(
    gpu: &Gpu,
    source: &wgpu::Buffer,
    count: usize,
) -> Result<Vec<T>, ReadbackError> {
    read_buffers(gpu, &[(source, count)])
}

/// As [`read_buffer`], of several buffers with the count of each: their items in order. All are
/// copied at once, because every copy waits for the adapter.
///
/// # Errors
/// As [`read_buffer`].
pub(crate) fn read_buffers<T: Pod>(
    gpu: &Gpu,
    sources: &[(&wgpu::Buffer, usize)],
) -> Result<Vec<T>, ReadbackError> {
    let buffer = copy_to_staging::<T>(gpu, sources)?;
    Ok(bytemuck::pod_collect_to_vec(&map(gpu, &buffer)?))
}

/// A read of a buffer that is under way.
#[derive(Debug)]
pub struct PendingRead<T> {
    buffer: wgpu::Buffer,
    answer: Receiver<Result<(), wgpu::BufferAsyncError>>,
    items: PhantomData<T>,
}

impl<T: Pod> PendingRead<T> {
    /// Begins to read the first `count` items of a buffer, as it is after everything that was
    /// submitted.
    ///
    /// # Errors
    /// As [`read_buffer`].
    pub fn begin(gpu: &Gpu, source: &wgpu::Buffer, count: usize) -> Result<Self, ReadbackError> {
        Self::begin_all(gpu, &[(source, count)])
    }

    /// As [`Self::begin`], of several buffers with the count of each: their items in order.
    ///
    /// # Errors
    /// As [`read_buffer`].
    pub(crate) fn begin_all(
        gpu: &Gpu,
        sources: &[(&wgpu::Buffer, usize)],
    ) -> Result<Self, ReadbackError> {
        let buffer = copy_to_staging::<T>(gpu, sources)?;
        Ok(Self { answer: begin_map(&buffer), buffer, items: PhantomData })
    }

    /// The items once they have arrived, `None` until then; does not wait.
    ///
    /// # Errors
    /// [`ReadbackError`], if the device is lost, and after the items were handed out.
    pub fn poll(&self, gpu: &Gpu) -> Result<Option<Vec<T>>, ReadbackError> {
        gpu.device.poll(wgpu::PollType::Poll).map_err(ReadbackError::new)?;
        match self.answer.try_recv() {
            Err(TryRecvError::Empty) => Ok(None),
            Err(error) => Err(ReadbackError::new(error)),
            Ok(answer) => {
                answer.map_err(ReadbackError::new)?;
                let bytes = self.buffer.get_mapped_range(..).map_err(ReadbackError::new)?;
                Ok(Some(bytemuck::pod_collect_to_vec(&bytes)))
            }
        }
    }
}

/// Submits a copy of the first items of each buffer to one that can be mapped.
fn copy_to_staging<T: Pod>(
    gpu: &Gpu,
    sources: &[(&wgpu::Buffer, usize)],
) -> Result<wgpu::Buffer, ReadbackError> {
    let sizes = sources.iter().map(|&(source, count)| copied_bytes::<T>(source, count));
    let sizes = sizes.collect::<Result<Vec<u64>, ReadbackError>>()?;
    let buffer = staging(gpu, sizes.iter().sum())?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut offset = 0;
    for ((source, _), byte_count) in sources.iter().zip(sizes) {
        encoder.copy_buffer_to_buffer(source, 0, &buffer, offset, byte_count);
        offset += byte_count;
    }
    gpu.queue.submit([encoder.finish()]);
    Ok(buffer)
}

/// The bytes of the first `count` items of a buffer, if they can be copied.
fn copied_bytes<T: Pod>(source: &wgpu::Buffer, count: usize) -> Result<u64, ReadbackError> {
    let byte_count = (count as u64).saturating_mul(size_of::<T>() as u64);
    if byte_count > source.size() {
        let has = source.size();
        return Err(ReadbackError::new(format!("{byte_count} bytes of a buffer of {has}")));
    }
    if !byte_count.is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
        return Err(ReadbackError::new(format!("{byte_count} bytes are not a multiple of 4")));
    }
    if !source.usage().contains(wgpu::BufferUsages::COPY_SRC) {
        return Err(ReadbackError::new("the buffer was made without the usage COPY_SRC"));
    }
    Ok(byte_count)
}

fn staging(gpu: &Gpu, size: u64) -> Result<wgpu::Buffer, ReadbackError> {
    let descriptor = wgpu::BufferDescriptor {
        label: Some("readback"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    };
    gpu.make(|| gpu.device.create_buffer(&descriptor)).map_err(ReadbackError::new)
}

fn begin_map(buffer: &wgpu::Buffer) -> Receiver<Result<(), wgpu::BufferAsyncError>> {
    let (sender, receiver) = channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // If the receiver is gone, nobody wants the answer.
        let _ = sender.send(result);
    });
    receiver
}

fn map(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, ReadbackError> {
    let receiver = begin_map(buffer);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(ReadbackError::new)?;
    receiver.recv().map_err(ReadbackError::new)?.map_err(ReadbackError::new)?;
    let bytes = buffer.get_mapped_range(..).map_err(ReadbackError::new)?.to_vec();
    buffer.unmap();
    Ok(bytes)
}
