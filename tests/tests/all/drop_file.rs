//! Drops a file on a window by the protocol of file managers (XDND, version 5).

use std::path::Path;
use std::time::{Duration, Instant};

use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, AtomEnum, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode,
    SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// Drops a file on the middle of a window of a display.
///
/// # Panics
/// If the window does not take it.
pub(crate) fn drop_file(display: &str, window: u32, file: &Path) {
    let (connection, screen) = x11rb::connect(Some(display)).unwrap();
    let source = Source::new(connection, screen, file);
    let atom = |name: &str| source.atom(name);
    let list = atom("text/uri-list");
    source.tell(window, "XdndEnter", [source.window, 5 << 24, list, 0, 0]);
    let place = source.middle_of(window);
    let copy = atom("XdndActionCopy");
    source.tell(window, "XdndPosition", [source.window, 0, place, x11rb::CURRENT_TIME, copy]);
    let status = source.wait_for("XdndStatus");
    assert_eq!(status[1] & 1, 1, "the window does not take files");
    source.tell(window, "XdndDrop", [source.window, 0, x11rb::CURRENT_TIME, 0, 0]);
    source.wait_for("XdndFinished");
}

/// The part of a file manager that a window sees.
struct Source {
    connection: RustConnection,
    window: Window,
    root: Window,
    list: String,
}

impl Source {
    fn new(connection: RustConnection, screen: usize, file: &Path) -> Self {
        let root = connection.setup().roots[screen].root;
        let window = connection.generate_id().unwrap();
        let (class, aux) = (WindowClass::INPUT_ONLY, CreateWindowAux::default());
        connection.create_window(0, window, root, 0, 0, 1, 1, 0, class, 0, &aux).unwrap();
        let list = format!("file://{}\r\n", file.display());
        let source = Self { connection, window, root, list };
        let selection = source.atom("XdndSelection");
        let owner = source.connection.set_selection_owner(window, selection, x11rb::CURRENT_TIME);
        owner.unwrap().check().unwrap();
        source
    }

    fn atom(&self, name: &str) -> Atom {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    /// The middle of a window on the screen, packed as in messages.
    fn middle_of(&self, window: Window) -> u32 {
        let size = self.connection.get_geometry(window).unwrap().reply().unwrap();
        let (x, y) = (size.width / 2, size.height / 2);
        let (x, y) = (i16::try_from(x).unwrap(), i16::try_from(y).unwrap());
        let place = self.connection.translate_coordinates(window, self.root, x, y).unwrap();
        let place = place.reply().unwrap();
        u32::try_from(place.dst_x).unwrap() << 16 | u32::try_from(place.dst_y).unwrap()
    }

    fn tell(&self, window: Window, what: &str, data: [u32; 5]) {
        let event = ClientMessageEvent::new(32, window, self.atom(what), data);
        self.connection.send_event(false, window, EventMask::NO_EVENT, event).unwrap();
        self.connection.flush().unwrap();
    }

    /// Waits for an answer of the window; sends the list of files if it asks meanwhile.
    fn wait_for(&self, what: &str) -> [u32; 5] {
        let (wanted, started) = (self.atom(what), Instant::now());
        while started.elapsed() < Duration::from_secs(30) {
            match self.connection.poll_for_event().unwrap() {
                Some(Event::ClientMessage(message)) if message.type_ == wanted => {
                    return message.data.as_data32();
                }
                Some(Event::SelectionRequest(request)) => self.give_list(&request),
                _ => std::thread::sleep(Duration::from_millis(5)),
            }
        }
        panic!("the window never answered with {what}");
    }

    fn give_list(&self, request: &SelectionRequestEvent) {
        let kind: Atom = request.target;
        let (requestor, property) = (request.requestor, request.property);
        assert_ne!(property, u32::from(AtomEnum::NONE), "no property for the list");
        let bytes = self.list.as_bytes();
        let change = PropMode::REPLACE;
        self.connection.change_property8(change, requestor, property, kind, bytes).unwrap();
        let notify = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time: request.time,
            requestor,
            selection: request.selection,
            target: kind,
            property,
        };
        self.connection.send_event(false, requestor, EventMask::NO_EVENT, notify).unwrap();
        self.connection.flush().unwrap();
    }
}
