//! The adapter and the device, asked for with what the crate needs and no more.
//!
//! Limits are WebGPU's defaults; only the sizes of buffers, bindings and textures are raised
//! to those of the adapter. So whatever runs on one adapter runs on any other with the
//! default limits, only smaller.

use thiserror::Error;
use wgpu::{Adapter, AdapterInfo, Backends, DownlevelFlags, Features, Instance, Limits};

/// A device with its queue. Cheap to clone: all clones are the same device.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// Name, backend and driver of the adapter.
    pub info: AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// The device's queue.
    pub queue: wgpu::Queue,
}

/// Why no device was opened.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No backend has an adapter.
    #[error(
        "no graphics adapter was found (tried {tried}); install a Vulkan driver, or on Debian and \
         Ubuntu the software one: sudo apt-get install mesa-vulkan-drivers libvulkan1"
    )]
    NoAdapter {
        /// The backends that were tried, separated by commas.
        tried: String,
    },
    /// No adapter's name contains the wanted one.
    #[error("no graphics adapter is called '{wanted}'; there are: {}", found.join(", "))]
    UnknownAdapter {
        /// The name asked for.
        wanted: String,
        /// The names of all adapters.
        found: Vec<String>,
    },
    /// The adapter lacks something that every picture needs.
    #[error("the graphics adapter '{name}' cannot be used, it lacks {}", lacks.join(", "))]
    Unsuitable {
        /// The adapter.
        name: String,
        /// The missing limits and capabilities.
        lacks: Vec<String>,
    },
    /// The driver refused to open the device.
    #[error("the graphics adapter '{name}' cannot open a device: {reason}")]
    NoDevice {
        /// The adapter.
        name: String,
        /// The driver's message.
        reason: String,
    },
}

/// Why buffers or textures were not made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ResourceError {
    /// The device has no memory for them.
    #[error("the graphics adapter ran out of memory")]
    OutOfMemory,
    /// wgpu rejected a call as invalid.
    #[error("a fault in the use of the graphics adapter: {0}")]
    Fault(String),
}

impl Gpu {
    /// Opens the adapter whose name contains `name` (ignoring case), or else the best one.
    ///
    /// # Errors
    /// [`GpuError`], with the backends that were tried or the adapters that were found.
    pub async fn open(name: Option<&str>) -> Result<Self, GpuError> {
        Self::open_with(name, |_| ()).await
    }

    /// Opens an adapter as [`Self::open`] does; `adjust` may lower the limits of the device,
    /// to try smaller adapters.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub async fn open_with(
        name: Option<&str>,
        adjust: impl FnOnce(&mut Limits),
    ) -> Result<Self, GpuError> {
        let (instance, backends) = Self::instance();
        let adapter = match name {
            None => instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await.ok(),
            Some(name) => Some(find_by_name(&instance, backends, name).await?),
        };
        let adapter = adapter.ok_or_else(|| GpuError::NoAdapter { tried: names_of(backends) })?;
        check(&adapter)?;
        let info = adapter.get_info();
        let mut descriptor = Self::device_descriptor(&adapter);
        adjust(&mut descriptor.required_limits);
        let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| {
            GpuError::NoDevice { name: info.name.clone(), reason: error.to_string() }
        })?;
        Ok(Self { info, device, queue })
    }

    /// Takes the device and queue of a program.
    ///
    /// The device needs WebGPU's default limits. Timestamps and 32 bits of depth beside a
    /// stencil need the features that [`Self::device_descriptor`] asks for; without them
    /// nothing is timed, and the depth beside a stencil has 24 bits.
    ///
    /// # Errors
    /// [`GpuError::Unsuitable`], if the device has lower limits.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, GpuError> {
        let info = device.adapter_info();
        let lacks = lacking_limits(&device.limits());
        match lacks.is_empty() {
            true => Ok(Self { info, device, queue }),
            false => Err(GpuError::Unsuitable { name: info.name, lacks }),
        }
    }

    /// The instance that the commands use, with the backends of [`Self::backends`].
    #[must_use]
    pub fn instance() -> (Instance, Backends) {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        descriptor.backends = Self::backends();
        (Instance::new(descriptor), Self::backends())
    }

    /// The backends named by the environment variable `WGPU_BACKEND`, or else the
    /// first-class ones of the platform. (OpenGL would list the software driver twice.)
    #[must_use]
    pub fn backends() -> Backends {
        let wanted = Backends::from_env().unwrap_or(Backends::PRIMARY) - Backends::NOOP;
        // Only what this platform has, so that a message names nothing else.
        wanted & Instance::enabled_backend_features()
    }

    /// What every picture needs and `adapter` lacks; empty if the adapter can be used.
    #[must_use]
    pub fn lacking(adapter: &Adapter) -> Vec<String> {
        let flags = adapter.get_downlevel_capabilities().flags;
        let needed = [
            (DownlevelFlags::COMPUTE_SHADERS, "compute shaders"),
            (DownlevelFlags::INDIRECT_EXECUTION, "indirect draws"),
            (DownlevelFlags::VERTEX_STORAGE, "storage buffers in vertex shaders"),
        ];
        let mut lacks: Vec<String> = needed
            .iter()
            .filter(|(flag, _)| !flags.contains(*flag))
            .map(|(_, what)| (*what).to_owned())
            .collect();
        lacks.extend(lacking_limits(&adapter.limits()));
        lacks
    }

    /// Picks the adapter whose name contains `name` (ignoring case), or else the best one
    /// that can draw to `surface`.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn choose_adapter(
        adapters: &[Adapter],
        name: Option<&str>,
        surface: Option<&wgpu::Surface>,
    ) -> Result<Adapter, GpuError> {
        let fits = |adapter: &&Adapter| {
            surface.is_none_or(|surface| adapter.is_surface_supported(surface))
        };
        let fitting: Vec<&Adapter> = adapters.iter().filter(fits).collect();
        let found = match name {
            None => fitting.into_iter().min_by_key(|adapter| slowness(adapter)),
            Some(name) => {
                let wanted = name.to_lowercase();
                let is_wanted =
                    |adapter: &&Adapter| adapter.get_info().name.to_lowercase().contains(&wanted);
                let found = fitting.iter().map(|adapter| adapter.get_info().name).collect();
                let known = fitting.into_iter().find(is_wanted);
                if known.is_none() && !adapters.is_empty() {
                    return Err(GpuError::UnknownAdapter { wanted: name.into(), found });
                }
                known
            }
        };
        let none = || GpuError::NoAdapter { tried: names_of(Self::backends()) };
        let adapter = found.ok_or_else(none)?;
        check(adapter)?;
        Ok(adapter.clone())
    }

    /// The features and limits that the crate asks of an adapter.
    #[must_use]
    pub fn device_descriptor(adapter: &Adapter) -> wgpu::DeviceDescriptor<'static> {
        let has = adapter.limits();
        wgpu::DeviceDescriptor {
            label: Some("edgemesh"),
            required_features: adapter.features()
                & (Features::TIMESTAMP_QUERY | Features::DEPTH32FLOAT_STENCIL8),
            required_limits: Limits {
                max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
                max_buffer_size: has.max_buffer_size,
                max_texture_dimension_2d: has.max_texture_dimension_2d,
                ..Limits::default()
            },
            ..wgpu::DeviceDescriptor::default()
        }
    }

    /// Runs `body`, which makes buffers and textures, and catches the errors of the device
    /// in it.
    ///
    /// # Errors
    /// [`ResourceError`]; the result of `body` is dropped, since it must not be used.
    pub fn make<T>(&self, body: impl FnOnce() -> T) -> Result<T, ResourceError> {
        // A buffer that was not made for lack of memory fails its checks as well: catch
        // both, and report memory first.
        let faults = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let made = body();
        let memory = pollster::block_on(memory.pop());
        let fault = pollster::block_on(faults.pop());
        match (memory, fault) {
            (Some(_), _) => Err(ResourceError::OutOfMemory),
            (None, Some(fault)) => Err(ResourceError::Fault(fault.to_string())),
            (None, None) => Ok(made),
        }
    }
}

fn check(adapter: &Adapter) -> Result<(), GpuError> {
    let lacks = Gpu::lacking(adapter);
    match lacks.is_empty() {
        true => Ok(()),
        false => Err(GpuError::Unsuitable { name: adapter.get_info().name, lacks }),
    }
}

/// The limits of WebGPU that `limits` fall short of.
fn lacking_limits(limits: &Limits) -> Vec<String> {
    let mut lacks = Vec::new();
    Limits::default().check_limits_with_fail_fn(limits, false, |name, need, has| {
        lacks.push(format!("{name} of {need} (it has {has})"));
    });
    lacks
}

/// The order of adapters: cards, then built-in ones, software last.
fn slowness(adapter: &Adapter) -> u32 {
    match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

async fn find_by_name(
    instance: &Instance,
    backends: Backends,
    name: &str,
) -> Result<Adapter, GpuError> {
    let adapters = instance.enumerate_adapters(backends).await;
    let found: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    if found.is_empty() {
        return Err(GpuError::NoAdapter { tried: names_of(backends) });
    }
    let wanted = name.to_lowercase();
    adapters
        .into_iter()
        .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted))
        .ok_or_else(|| GpuError::UnknownAdapter { wanted: name.into(), found })
}

fn names_of(backends: Backends) -> String {
    let names: Vec<String> = backends.iter_names().map(|(name, _)| name.to_lowercase()).collect();
    names.join(", ")
}
