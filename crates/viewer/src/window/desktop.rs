//! Whether the desktop is light or dark, and whether it has file dialogs.
//!
//! On Linux the desktop portal answers both. Its setting `color-scheme` of
//! `org.freedesktop.appearance` is 1 for dark and 2 for light (XDG Desktop Portal, Settings).
//! On other systems the window system does, and this file does nothing.

use egui::Context;

/// Sets the fallback theme of the window from the desktop, and follows its changes. Without a
/// portal the window stays light.
#[cfg(all(unix, not(target_os = "macos")))]
pub(super) fn follow_theme(context: &Context) {
    context.options_mut(|options| options.fallback_theme = egui::Theme::Light);
    let context = context.clone();
    std::thread::spawn(move || {
        // Many desktops have no portal.
        let told = zbus::blocking::Connection::session()
            .and_then(|connection| portal::follow(&connection, &context));
        if let Err(error) = told {
            log::info!("the desktop does not say whether it is light or dark: {error}");
        }
    });
}

/// The window system sets the theme.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub(super) fn follow_theme(_: &Context) {}

/// What to install for file dialogs; `None` if they work.
#[cfg(all(unix, not(target_os = "macos")))]
pub(super) fn missing_for_dialogs() -> Option<&'static str> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let has_zenity = std::env::split_paths(&folders).any(|folder| folder.join("zenity").is_file());
    let has_any = has_zenity || portal::is_there();
    (!has_any).then_some("this desktop has no file dialog: install zenity or xdg-desktop-portal")
}

/// The system has file dialogs.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub(super) const fn missing_for_dialogs() -> Option<&'static str> {
    None
}

#[cfg(all(unix, not(target_os = "macos")))]
mod portal {
    use egui::{Context, Theme};
    use zbus::blocking::{Connection, Proxy};
    use zbus::zvariant::{OwnedValue, Value};

    const PORTAL: &str = "org.freedesktop.portal.Desktop";
    const NAMESPACE: &str = "org.freedesktop.appearance";
    const KEY: &str = "color-scheme";

    /// Whether a portal is running or can be started.
    pub(super) fn is_there() -> bool {
        let names = || {
            let connection = Connection::session()?;
            let bus = zbus::blocking::fdo::DBusProxy::new(&connection)?;
            let mut names = bus.list_names()?;
            names.extend(bus.list_activatable_names()?);
            zbus::Result::Ok(names)
        };
        names().is_ok_and(|names| names.iter().any(|name| name.as_str() == PORTAL))
    }

    pub(super) fn follow(connection: &Connection, context: &Context) -> zbus::Result<()> {
        let settings = Proxy::new(
            connection,
            PORTAL,
            "/org/freedesktop/portal/desktop",
            "org.freedesktop.portal.Settings",
        )?;
        // Subscribed before reading, so that no change is missed in between.
        let changes = settings.receive_signal("SettingChanged")?;
        // Portals before version 2 have only Read, which wraps the value once more.
        let read = |method: &str| settings.call::<_, _, OwnedValue>(method, &(NAMESPACE, KEY));
        let value: OwnedValue = read("ReadOne").or_else(|_| read("Read"))?;
        take(context, &value);
        for change in changes {
            let body = change.body();
            let (namespace, key, value): (String, String, OwnedValue) = body.deserialize()?;
            if (namespace.as_str(), key.as_str()) == (NAMESPACE, KEY) {
                take(context, &value);
            }
        }
        Ok(())
    }

    fn take(context: &Context, value: &Value) {
        if let Some(theme) = theme_of(value) {
            context.options_mut(|options| options.fallback_theme = theme);
            context.request_repaint();
        }
    }

    fn theme_of(value: &Value) -> Option<Theme> {
        match value {
            Value::Value(inner) => theme_of(inner),
            Value::U32(1) => Some(Theme::Dark),
            Value::U32(_) => Some(Theme::Light),
            _ => None,
        }
    }

    #[cfg(test)]
    mod tests {
        use std::os::unix::net::UnixStream;
        use std::time::{Duration, Instant};

        use zbus::blocking::connection::Builder;

        use super::*;

        const PATH: &str = "/org/freedesktop/portal/desktop";
        const SETTINGS: &str = "org.freedesktop.portal.Settings";

        /// A desktop that is dark at first.
        struct Desktop;

        #[zbus::interface(name = "org.freedesktop.portal.Settings")]
        impl Desktop {
            #[expect(clippy::unused_self, reason = "how interfaces are written")]
            fn read_one(&self, namespace: &str, key: &str) -> zbus::fdo::Result<OwnedValue> {
                assert_eq!((namespace, key), (NAMESPACE, KEY));
                Ok(OwnedValue::from(1_u32))
            }
        }

        fn wait_for(context: &Context, theme: Theme) {
            let started = Instant::now();
            while context.options(|options| options.fallback_theme) != theme {
                assert!(started.elapsed() < Duration::from_secs(20), "{theme:?} never came");
                std::thread::sleep(Duration::from_millis(5));
            }
        }

        #[test]
        fn the_window_is_dark_as_the_desktop_is_and_turns_light_with_it() {
            let (ours, theirs) = UnixStream::pair().unwrap();
            let desktop = std::thread::spawn(move || {
                let builder = Builder::async_io_unix_stream(theirs).server(zbus::Guid::generate());
                builder.unwrap().p2p().serve_at(PATH, Desktop).unwrap().build().unwrap()
            });
            let connection = Builder::async_io_unix_stream(ours).p2p().build().unwrap();
            let desktop = desktop.join().unwrap();
            let context = Context::default();
            context.options_mut(|options| options.fallback_theme = Theme::Light);
            let followed = context.clone();
            std::thread::spawn(move || follow(&connection, &followed));
            wait_for(&context, Theme::Dark);
            let tell = |namespace: &str, scheme: u32| {
                let body = (namespace, KEY, Value::from(scheme));
                let nobody: Option<&str> = None;
                desktop.emit_signal(nobody, PATH, SETTINGS, "SettingChanged", &body).unwrap();
            };
            tell("org.example.other", 1);
            tell(NAMESPACE, 2);
            wait_for(&context, Theme::Light);
        }

        #[test]
        fn one_is_dark_and_without_a_preference_it_is_light() {
            assert_eq!(theme_of(&Value::U32(1)), Some(Theme::Dark));
            assert_eq!(theme_of(&Value::U32(2)), Some(Theme::Light));
            assert_eq!(theme_of(&Value::U32(0)), Some(Theme::Light));
            let wrapped = Value::Value(Box::new(Value::U32(1)));
            assert_eq!(theme_of(&wrapped), Some(Theme::Dark));
            assert_eq!(theme_of(&Value::from("dark")), None);
        }
    }
}
