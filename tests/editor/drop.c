/* Drops files onto a window as a file manager does, by the protocol XDND: drop X Y FILE ... At that place of the
 * screen. Exit code 0: the window has taken them. */
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Display* display;

static Atom atom(const char* name) {
    return XInternAtom(display, name, False);
}

static void tell(Window source, Window target, const char* what, long a, long b, long c, long d) {
    XEvent event = {0};
    event.xclient.type = ClientMessage;
    event.xclient.window = target;
    event.xclient.message_type = atom(what);
    event.xclient.format = 32;
    event.xclient.data.l[0] = (long)source;
    event.xclient.data.l[1] = a;
    event.xclient.data.l[2] = b;
    event.xclient.data.l[3] = c;
    event.xclient.data.l[4] = d;
    XSendEvent(display, target, False, NoEventMask, &event);
    XFlush(display);
}

/* The window there that takes drops; 0: none does. */
static Window windowAt(int x, int y) {
    Window root = DefaultRootWindow(display), at = root, child = 0;
    int inX, inY;
    while (XTranslateCoordinates(display, root, at, x, y, &inX, &inY, &child) && child) {
        Atom type;
        int format;
        unsigned long count, left;
        unsigned char* version = NULL;
        at = child;
        XGetWindowProperty(display, at, atom("XdndAware"), 0, 1, False, AnyPropertyType, &type, &format, &count, &left,
                           &version);
        if (version) XFree(version);
        if (type != None) return at;
    }
    return 0;
}

static void giveFiles(const XSelectionRequestEvent* asked, const char* list) {
    XEvent event = {0};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = asked->requestor;
    event.xselection.selection = asked->selection;
    event.xselection.target = asked->target;
    event.xselection.property = asked->property;
    event.xselection.time = asked->time;
    XChangeProperty(display, asked->requestor, asked->property, asked->target, 8, PropModeReplace,
                    (const unsigned char*)list, (int)strlen(list));
    XSendEvent(display, asked->requestor, False, NoEventMask, &event);
    XFlush(display);
}

int main(int argc, char** argv) {
    char list[65536] = "";
    if (argc < 4 || !(display = XOpenDisplay(NULL))) return 2;
    for (int i = 3; i < argc; ++i) {
        if (strlen(list) + strlen(argv[i]) + 16 > sizeof list) return 2;
        strcat(strcat(strcat(list, "file://"), argv[i]), "\r\n");
    }
    const int x = atoi(argv[1]), y = atoi(argv[2]);
    const Window source = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0),
                 target = windowAt(x, y);
    if (!target) return 3;
    XSetSelectionOwner(display, atom("XdndSelection"), source, CurrentTime);
    tell(source, target, "XdndEnter", 5L << 24, (long)atom("text/uri-list"), 0, 0);
    tell(source, target, "XdndPosition", 0, (long)x << 16 | y, CurrentTime, (long)atom("XdndActionCopy"));
    alarm(60); /* it ends the program */
    for (int dropped = 0;;) {
        XEvent event;
        XNextEvent(display, &event);
        if (event.type == SelectionRequest) giveFiles(&event.xselectionrequest, list);
        if (event.type != ClientMessage) continue;
        if (event.xclient.message_type == atom("XdndStatus") && !dropped++)
            tell(source, target, "XdndDrop", 0, CurrentTime, 0, 0);
        if (event.xclient.message_type == atom("XdndFinished")) return 0;
    }
}
