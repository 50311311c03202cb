#pragma once

#include "sample_game/gui_events.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Procedural graphs in the editor: the bar of their time below the view, and below that the node editor.
void showGraphs(Workspace& work);
// While they play, the frame that is due by now, seconds of the window's clock.
void playGraphs(Workspace& work, double now);
// Keys of time: Space, the arrows, Ctrl+Home. False: it is none of them, or there are no graphs.
bool takeTimeKey(Workspace& work, const KeyEvent& event);
// Keys that are pressed over the canvas of nodes. False: it isn't, or the key means nothing there.
bool takeNodeKey(Workspace& work, const KeyEvent& event);
// A graph with nothing in it comes to the scene and is opened.
void addGraph(Workspace& work);
// The key asks for the list of nodes: what is typed next is meant for its search.
bool asksForNode(int key, bool control, bool shift, float x, float y);
bool nodeListAwaits();                        // it was asked for, and can't be typed into yet
void forgetNodeList();                        // while the canvas isn't shown
void showNodes(Workspace& work, bool shown);  // the node editor; where there are no graphs, that is told

}  // namespace sample
