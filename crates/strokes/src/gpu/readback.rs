//! From the GPU back to memory: pictures and buffers.

use std::marker::PhantomData;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use bytemuck::Pod;
use image::RgbaImage;
use thiserror::Error;

use crate::gpu::device::Gpu;

/// The GPU did not hand its memory back.
#[derive(Debug, Error)]
#[error("the picture could not be read back from the graphics adapter: {reason}")]
pub struct ReadbackError {
    /// What the driver said.
    pub reason: String,
}

impl ReadbackError {
    fn new(reason: impl std::fmt::Display) -> Self {
        Self { reason: reason.to_string() }
    }
}

/// Reads an RGBA texture of 8 bits a channel and one sample; waits for all
/// submitted work.
///
/// # Errors
/// Where the device is lost or has no room for the copy.
pub fn read_picture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, ReadbackError> {
    RgbaImage::from_raw(texture.width(), texture.height(), read_texels(gpu, texture, 4)?)
        .ok_or_else(|| ReadbackError::new("it gave too few bytes"))
}

/// Reads a texture of one sample and so many bytes a texel, row by row.
///
/// # Errors
/// Where the device is lost or has no room for the copy.
pub fn read_texels<T: Pod>(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    bytes_per_texel: u32,
) -> Result<Vec<T>, ReadbackError> {
    let (width, height) = (texture.width(), texture.height());
    let row_bytes = bytes_per_texel * width;
    let padded_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = staging(gpu, u64::from(padded_bytes) * u64::from(height))?;
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

/// Reads the first `count` items of a buffer that may be copied from.
///
/// # Errors
/// Where the device is lost or has no room for the copy.
pub fn read_buffer<T: Pod>(
    gpu: &Gpu,
    source: &wgpu::Buffer,
    count: usize,
) -> Result<Vec<T>, ReadbackError> {
    let byte_count = (count * size_of::<T>()) as u64;
    let buffer = staging(gpu, byte_count)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, byte_count);
    gpu.queue.submit([encoder.finish()]);
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
    /// Begins to read the first `count` items of a buffer that may be copied from, as it
    /// is after everything that was submitted.
    ///
    /// # Errors
    /// Where the device is lost or has no room for the copy.
    pub fn begin(gpu: &Gpu, source: &wgpu::Buffer, count: usize) -> Result<Self, ReadbackError> {
        let byte_count = (count * size_of::<T>()) as u64;
        let buffer = staging(gpu, byte_count)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, byte_count);
        gpu.queue.submit([encoder.finish()]);
        Ok(Self { answer: begin_map(&buffer), buffer, items: PhantomData })
    }

    /// The items, if they are there; does not wait.
    ///
    /// # Errors
    /// Where the device is lost.
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
