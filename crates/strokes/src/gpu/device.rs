//! The adapter and the device, asked for with what the crate needs and no more.
//!
//! Limits are data: the defaults of WebGPU, with only the sizes of buffers,
//! bindings and textures raised to what the adapter has. So whatever runs here
//! runs on any adapter of the default limits, only smaller.

use thiserror::Error;
use wgpu::{Adapter, AdapterInfo, Backends, DownlevelFlags, Features, Instance, Limits};

/// A device with its queue. Cheap to clone: all clones are the same device.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// What the adapter says of itself.
    pub info: AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// Why there is no device.
#[derive(Debug, Error)]
pub enum GpuError {
    /// No adapter at all on the backends that were tried.
    #[error(
        "no graphics adapter was found (tried {tried}); install a Vulkan driver, or on Debian and \
         Ubuntu the software one: sudo apt-get install mesa-vulkan-drivers libvulkan1"
    )]
    NoAdapter {
        /// The backends.
        tried: String,
    },
    /// Adapters, but none of the wanted name.
    #[error("no graphics adapter is called '{wanted}'; there are: {}", found.join(", "))]
    UnknownAdapter {
        /// The name asked for.
        wanted: String,
        /// The names there are.
        found: Vec<String>,
    },
    /// The adapter lacks something that every picture needs.
    #[error("the graphics adapter '{name}' cannot be used, it lacks {}", lacks.join(", "))]
    Unsuitable {
        /// The adapter.
        name: String,
        /// What is missing.
        lacks: Vec<String>,
    },
    /// The driver refused to open the device.
    #[error("the graphics adapter '{name}' gave no device: {reason}")]
    NoDevice {
        /// The adapter.
        name: String,
        /// What the driver said.
        reason: String,
    },
}

/// Why buffers or textures could not be made.
#[derive(Debug, Error)]
pub enum ResourceError {
    /// The device has no room for them.
    #[error("the graphics adapter ran out of memory")]
    OutOfMemory,
    /// A fault of ours that the driver's checks found.
    #[error("a fault in the use of the graphics adapter: {0}")]
    Fault(String),
}

impl Gpu {
    /// Opens the adapter whose name contains `name` (ignoring case), or else the best one.
    ///
    /// # Errors
    /// [`GpuError`] with what was tried and what was found.
    pub async fn open(name: Option<&str>) -> Result<Self, GpuError> {
        open(name).await
    }

    /// Takes a device that the program has already, with its queue.
    ///
    /// Pipelines need the limits of [`device_descriptor`]; timestamps and the most exact depth
    /// with a stencil need its features, if they are wanted.
    ///
    /// # Errors
    /// [`GpuError::Unsuitable`], if the device has lower limits than WebGPU's defaults.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, GpuError> {
        let info = device.adapter_info();
        let mut lacks = Vec::new();
        Limits::default().check_limits_with_fail_fn(&device.limits(), false, |name, need, has| {
            lacks.push(format!("{name} of {need} (it has {has})"));
        });
        match lacks.is_empty() {
            true => Ok(Self { info, device, queue }),
            false => Err(GpuError::Unsuitable { name: info.name, lacks }),
        }
    }

    /// Runs `body`, which makes buffers and textures, and catches what goes wrong
    /// in it on the device.
    ///
    /// # Errors
    /// [`ResourceError`]; what `body` made must then not be used, so it is dropped.
    pub fn make<T>(&self, body: impl FnOnce() -> T) -> Result<T, ResourceError> {
        // What was not made for lack of memory fails its checks as well, so
        // both are caught and memory is told first.
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

/// The instance that all commands use: the backends of `WGPU_BACKEND`, or the
/// first-class ones of the platform. (The OpenGL one would list the software
/// driver a second time.)
#[must_use]
pub fn instance() -> (Instance, Backends) {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends = backends();
    (Instance::new(descriptor), backends())
}

/// The backends of [`instance`].
#[must_use]
pub fn backends() -> Backends {
    let wanted = Backends::from_env().unwrap_or(Backends::PRIMARY) - Backends::NOOP;
    // Only what this platform has, so that a message names nothing else.
    wanted & Instance::enabled_backend_features()
}

/// What `adapter` lacks of what every picture needs; empty where it will do.
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
    Limits::default().check_limits_with_fail_fn(&adapter.limits(), false, |name, need, has| {
        lacks.push(format!("{name} of {need} (it has {has})"));
    });
    lacks
}

/// Opens the adapter whose name contains `name` (any case), or the best one.
///
/// # Errors
/// [`GpuError`] with what was tried and what was found.
pub async fn open(name: Option<&str>) -> Result<Gpu, GpuError> {
    open_with(name, |_| ()).await
}

/// As [`open`], with limits that `adjust` may lower, to see what happens on
/// smaller adapters.
///
/// # Errors
/// As [`open`].
pub async fn open_with(
    name: Option<&str>,
    adjust: impl FnOnce(&mut Limits),
) -> Result<Gpu, GpuError> {
    let (instance, backends) = instance();
    let adapter = match name {
        None => instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await.ok(),
        Some(name) => Some(find_by_name(&instance, backends, name).await?),
    };
    let adapter = adapter.ok_or_else(|| GpuError::NoAdapter { tried: names_of(backends) })?;
    check(&adapter)?;
    let info = adapter.get_info();
    let mut descriptor = device_descriptor(&adapter);
    adjust(&mut descriptor.required_limits);
    let (device, queue) = adapter.request_device(&descriptor).await.map_err(|error| {
        GpuError::NoDevice { name: info.name.clone(), reason: error.to_string() }
    })?;
    Ok(Gpu { info, device, queue })
}

fn check(adapter: &Adapter) -> Result<(), GpuError> {
    let lacks = lacking(adapter);
    match lacks.is_empty() {
        true => Ok(()),
        false => Err(GpuError::Unsuitable { name: adapter.get_info().name, lacks }),
    }
}

/// Of some adapters that whose name contains `name` (any case), or the best one that can
/// draw to `surface`.
///
/// # Errors
/// As [`open`].
pub fn choose(
    adapters: &[Adapter],
    name: Option<&str>,
    surface: Option<&wgpu::Surface>,
) -> Result<Adapter, GpuError> {
    let fits =
        |adapter: &&Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
    let fitting: Vec<&Adapter> = adapters.iter().filter(fits).collect();
    let found = match name {
        // Real cards before those that are built in, and software last.
        None => fitting.into_iter().min_by_key(|adapter| match adapter.get_info().device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        }),
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
    let adapter = found.ok_or_else(|| GpuError::NoAdapter { tried: names_of(backends()) })?;
    check(adapter)?;
    Ok(adapter.clone())
}

/// What is asked of an adapter: the features and limits that the crate uses.
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
