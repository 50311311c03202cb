#pragma once

// What the panels are put together from, besides ImGui's own widgets.

#include <functional>
#include <span>
#include <string>

#include "sample_game/workspace.hpp"

namespace sample {

// Of every window that may appear while a dialogue is open: taking the focus from it then ends ImGui 1.86 in an
// assertion.
constexpr int kQuiet = 1 << 12;  // ImGuiWindowFlags_NoFocusOnAppearing

// ImGui::Begin of a window that the user may move, with where and how large it is the first time. It stays between the
// bars at the top and bottom, whatever the size of window and letters becomes, and is as the user had it where there is
// room for it again.
bool beginWindow(const Workspace& work, const char* title, bool* open, glm::vec2 at, glm::vec2 size, int flags = 0);

// A value between two others as a bar, with the number over it. A drag moves it, a click sets it a moment later, since
// a double click types it, as does Ctrl and a click. True: it has changed. byRatio: each part of the way multiplies it;
// low > 0.
// `read` understands what is typed where that is more than a number, as `format` then shows it; false: it doesn't.
using ReadTyped = bool (*)(const char* text, float& value);
bool slider(const char* id, float* value, float low, float high, const char* format, bool byRatio = false,
            ReadTyped read = nullptr);
// After its label, to the end of the row.
bool labelledSlider(const char* label, float* value, float low, float high, const char* format, bool byRatio = false,
                    ReadTyped read = nullptr);
bool hoursOf(const char* text, float& hours);                   // a ReadTyped: 14:30, or 14.5
bool chosenButton(const char* label, bool on, glm::vec2 size);  // lit while `on`
void rowLabel(const char* text);  // the words before a widget, which takes the rest of the row
// Words that have to do with the room there is: what is cut ends in an ellipsis, and the whole is its tip.
std::string shortened(const std::string& text, float room);
void label(const char* text);
bool checkBox(const char* label, bool* on);
// Likewise, drawn as an eye and as a lock, without words.
bool eyeBox(const char* id, bool* open);
bool lockBox(const char* id, bool* closed);
bool beginCombo(const char* id, const std::string& shown);  // ImGui::BeginCombo; what is cut stands first in its tip
// ImGui::SameLine if something so wide still fits in the row.
void sameLineIfRoom(float width);
// A linear colour, as ImGui has colours.
uint32_t shownColour(const float (&rgb)[3]);
// Controls of up to three values that needn't be the document's, which `layOut` lays out as one item or group: Esc
// takes back a drag of them. What `layOut` says.
bool keepingDrag(const char* id, std::span<float> values, const std::function<bool()>& layOut);
// A field and a picker for a linear colour, as a grammar's text writes it; a click on the field at its end opens the
// picker.
bool editColour(const char* id, float* rgb);
// espViewColour's, as ImGui has colours; black: it has none.
uint32_t viewColour(EspView view, float amount);
void hint(const char* text);   // what keeps the user from seeing anything happen
void aside(const char* text);  // fainter, over as many lines as it takes
// Over the picture, beside a place of the window, legible on anything.
void noteAt(const Workspace& work, glm::vec2 at, const char* text);
// Shown when the mouse rests on the last widget, a disabled one too, beside the window that this is in.
void toolTip(const char* text);
void tip(const char* text);  // at the mouse, now; no wider than the window
// Whether the pointer rests on something that will show its tip in a moment.
bool toolTipWaits();

// Whether a slider that was clicked waits for the click to be no double click.
bool clickWaits();
// That, or something is typed in a slider's place.
bool sliderWaits();
bool sliderWaits(float x, float y);  // of sliders that don't lie there
// Sliders take what they wait for when the panels are laid out next; whatever is typed into is left.
void leaveFields();

// A panel's control is held by the mouse.
bool holdsControl();
// Takes back what it has done, and lets go of it. False: there is none.
bool cancelDrag(Workspace& work);
void finishDrag();  // lets go of it: what it has done stays

// Once a frame, before anything is laid out: what is taken up from here on is a step of undo of its own.
void beginGesture(Workspace& work);
// The number that belongs to the widget that is being dragged or typed into: what it does is one step of undo.
uint32_t widgetGesture(Workspace& work);

}  // namespace sample
