#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sample_game/view_camera.hpp"
#include "tools/document/document.hpp"

namespace sample {

enum class Tool { look, paint, seeds, path, branch, houses, fields };

// What the brush paints with, but for what the keys say while it does.
struct Brush {
    std::string layer;
    std::string mode = "paint";  // or "erase", "smooth": StrokeBegin::mode without keys that are held
    float radius = .25f;         // metres
    float townRadius = 3;        // of layers over a town, whose houses are seen from afar
    float strength = .6f, hardness = .5f, value = 1;
    float colour[3] = {.54f, .1f, .02f};  // of layers of colours, linear, in place of the value
    float spacing = .3f;                  // of the radius, between two dabs
    bool limited = false;                 // to slopes and heights
    float slope[2] = {0, 180};            // degrees between the surface's normal and the upward
    float height[2] = {-1e6f, 1e6f};      // metres
    float softness = .3f;
    bool frontOnly = false;
};

constexpr float kLeastPanel = 200, kMostPanel = 800;         // its width at 96 dpi
constexpr float kTimeBar = 34;                               // its height at 96 dpi
constexpr float kSmallestBrush = .005f, kLargestBrush = 20;  // radius, metres
constexpr float kLeastRowStep = .02f, kMostRowStep = 5;      // metres

// What is remembered from one run to the next, besides the places of movable windows.
struct Layout {
    bool panel = true, figures = false, grammar = false, atlas = false, help = false;
    float panelWidth = 320;                      // at 96 dpi
    uint32_t windowWidth = 0, windowHeight = 0;  // 0: never opened
    bool maximised = false;
    float sizeOfAll = 1;        // of letters and panels, besides the display's own scale
    float layerOpacity = .75f;  // of the layer that is seen on the model
    bool smallerWhileMoving = true;
    float rowStep = .25f;             // metres between two seeds of a row
    bool rowAlong = false;            // each looks along the row, else upward
    std::vector<std::string> recent;  // what was opened or saved, the latest first
    void noteRecent(const std::string& file);
};

// Parts of the scene: keys of plants, indices of models and of houses.
struct Chosen {
    std::vector<uint32_t> plants, models, houses;
    bool empty() const { return plants.empty() && models.empty() && houses.empty(); }
};

struct HouseHit {
    uint32_t house = 0;
    float distance = 0;  // along the ray
};

// Of clicks beside what the baker has made ground of.
inline constexpr const char* kNoGround = "No ground for plants there: key 2 shows it in colours";

// What the tools and the panels of the editor share: the document, how it is looked at, what is chosen.
struct Workspace {
    std::unique_ptr<EspContext, void (*)(EspContext*)> context{nullptr, espDestroy};
    std::unique_ptr<espalier::document::Document> document;
    ViewCamera camera;
    EspCamera start{};    // where one begins to look at what is open
    bool looked = false;  // a menu has moved the camera: who tells of its moves hasn't heard of it

    // How the window is: size in ImGui's units, scale of the display, what the panel takes at the left (of the width).
    glm::vec2 window{1280, 720};
    float scale = 1;
    bool editing = false;                // Tab: the editor is open
    bool manual = false, about = false;  // of the menu Help, open
    bool busy = false;  // a tool or a drag in a panel goes on with what is to be one step: nothing may come between

    Tool tool = Tool::look;
    Brush brush;
    std::set<uint32_t> selected;         // keys of seeds
    std::optional<uint64_t> branch;      // key of the one that was picked
    std::vector<EspPathSample> path;     // its walk; what grows anew may have lost it
    int windowsAnew = 0;                 // frames in which windows go where they were at first
    std::vector<bool> crossings;         // of the walk; see crossingsOf
    EspBranchInfo branchInfo{};          // while there is a path
    std::vector<EspPathSample> pointed;  // the walk of the branch under the mouse, while one may be picked
    std::optional<uint32_t> house;       // of the town, that was chosen
    std::optional<uint32_t> houseEdge;   // of its outer ring
    // The field in hand, the kind and reach of the next element or brush, how strong that is, and the chosen element.
    struct {
        std::string name, kind = "regular";
        float radius = 0, strength = .6f;
        size_t surface = 0;
        std::optional<size_t> element;
    } field;
    uint32_t plantGrammar = 0;
    uint32_t viewLevel = 0;     // whose charts are seen on the model
    uint32_t openGrammar = 0;   // in the grammar's window
    uint32_t shownGrammar = 0;  // whose text F4 opens: of the group that is open in the panel
    Layout layout;

    // The graph that is open in the node editor, whether that is, and the time that graphs show.
    struct {
        uint32_t open = 0;
        bool nodes = false;
        float height = 300;  // of the node editor, at 96 dpi
        bool playing = false;
        double playedFrom = 0;  // when the frame below was shown
        uint32_t playedFrame = 0;
        uint32_t lastFrame = 250;  // of the bar that is scrubbed; playing goes round there
    } graphs;

    std::string message, error;      // the latest of each
    uint64_t grownRevision = 0;      // of the document that stats tell of
    bool growsWide = false;          // since then something was done that may grow most plants anew
    const char* underWay = nullptr;  // what the next click does, while a tool follows the mouse without one
    EspStats stats{};
    EspRoofStats roofs{};
    double grownMs = 0;                         // of the latest growth, plants and houses that grew in it
    double frameMs = 0;                         // of the window, the last one
    double pictureMs = 0;                       // and of the last in which the scene was drawn
    std::vector<std::array<float, 4>> history;  // expand, emit, draw, frame; milliseconds of the latest frames

    // What the mouse points at in the scene, if it points at anything and isn't over a panel.
    std::optional<EspHit> hit;
    bool redraw = true;                                       // the scene's picture is out of date
    bool screenshot = false;                                  // the next frame is to be written as a picture
    std::optional<std::pair<uint32_t, std::string>> written;  // a grammar's text that has just gone into its file

    // Of a file: an ImTextureID and its aspect, see ShownPictures. Empty: nobody can show any.
    std::function<void*(const std::string& file, float& aspect)> pictureOf;

    const espalier::scene::Scene& scene() const { return document->scene(); }
    float shift() const;
    // Of the surfaces, else of the houses, world; a metre's cube if there are none.
    std::pair<glm::vec3, glm::vec3> bounds() const;
    float reach() const;                      // how large the scene is, metres
    std::optional<EspTownInfo> town() const;  // nothing: there is none
    void lookFrom(const EspCamera& from);
    void lookFromStart() { lookFrom(start); }
    // The view as it is, into a picture's file. False: `error` says why.
    bool writeView(const std::string& file, uint32_t width, uint32_t height);
    void keepBookmark(uint32_t digit);      // of the view as it is
    bool lookFromBookmark(uint32_t digit);  // false: there is none, which is told
    void frameAll();
    void frameChosen();          // what is chosen with the tool in hand fills the view; everything, if nothing is
    float dockUnits() const;     // what the node editor and the bar of time take at the bottom, without the status
    glm::vec2 viewSize() const;  // of the window without that
    float panelUnits() const;    // what the panel takes at the left, in ImGui's units
    float freeAspect() const;    // width by height of what it leaves
    // A message appears where it fails.
    bool perform(const espalier::document::Action& action, uint32_t gesture = 0);
    void takeBack(uint32_t gesture);  // undoes it, if nothing else was done since
    // News of what the user has just tried; what failed before doesn't hide it.
    void say(std::string text) { message = std::move(text), error.clear(); }
    // What was told isn't so any more.
    void remedied(const std::string& told) {
        if (error == told) error.clear();
    }
    // What is in hand and open, over a reload of the scene; what isn't there any more is left.
    struct Hands {
        std::string layer;
        uint32_t plantGrammar = 0, openGrammar = 0;
        std::optional<uint32_t> house, houseEdge;
        espalier::document::SetView view;
        std::string houseId;  // of the plan, which may have got others before it; empty: it has none
        uint32_t houseCorners = 0;
    };
    Hands hands() const;
    void takeUp(const Hands& hands);  // what was said of the reload stays
    // Painting shows what is painted, everything else the scene; so does walking, whatever tool waits.
    void choose(Tool chosen);
    void setEditing(bool edits);
    void showGrammar(bool shown, uint32_t index) { layout.grammar = shown, openGrammar = index; }
    void showAtlas(bool shown);  // where there is none, that is told
    // A number for the actions that belong together from now on.
    uint32_t newGesture() { return ++gesture_; }
    uint32_t gesture() const { return gesture_; }

    // A layer that lies over the town, seen from above, and over no surface.
    bool townLayer(const std::string& name) const;
    void chooseLayer(const std::string& name);  // for the brush
    void fitBrush();            // one that was used in a scene of quite another size: to .2 to 15 % of this one
    void showLayer(bool seen);  // the brush's, on the model
    void followLayers();        // a grammar's text may have lost the one in hand, or that is seen, and gained others
    float& brushRadius() { return townLayer(brush.layer) ? brush.townRadius : brush.radius; }
    float brushRadius() const { return townLayer(brush.layer) ? brush.townRadius : brush.radius; }
    // Paint that falls straight down on a town knows neither slopes nor heights.
    bool brushLimited() const { return brush.limited && !townLayer(brush.layer); }

    Ray rayThrough(glm::vec2 at) const;
    std::optional<EspHit> pick(glm::vec2 at) const;        // a surface
    std::optional<EspHit> pickGround(glm::vec2 at) const;  // one that no house is before
    // What the brush goes over: surfaces; with a layer of the town also houses and ground.
    std::optional<EspHit> aim(glm::vec2 at) const;
    void pickBranch(glm::vec2 at);
    void pointAtBranch(std::optional<glm::vec2> at);  // nothing: the mouse isn't over the scene
    void pickParent();                                // the branch that the picked one leaves from
    // The nearest that it meets before that distance. boxes: where it meets none, one whose box it goes through.
    std::optional<HouseHit> meetHouse(const Ray& ray, float before, bool boxes = true) const;
    // Each of the points: a house hides it, if only by a roof that it lies behind, or a surface does.
    std::vector<bool> hidden(const std::vector<glm::vec3>& points) const;
    std::optional<uint32_t> pickHouse(glm::vec2 at) const;
    // What stops who walks: surfaces, houses and the ground; see Meets.
    bool meets(const Ray& ray, float reach, EspHit& met) const;
    const espalier::scene::Seed* branchSeed() const;  // of the picked branch; null: none is picked
    // Cuts the picked branch away, if it is still there and its plant isn't frozen.
    void prune();
    // All seeds get other random numbers.
    void renumberSeeds();
    // Of frozen ones it is said that nothing will be seen of it yet.
    void changeSeeds(const espalier::document::ChangeSeeds& change, uint32_t gesture = 0);
    // Lets the chosen seeds' plants stand as they are, or grow again.
    void freeze(const std::vector<uint32_t>& keys, bool frozen);
    // The house in the hands of its tool, or the chosen plants.
    Chosen chosen() const;
    // Hides what is chosen; all else of its kind; shows whatever is hidden.
    void hideChosen();
    void isolateChosen();
    void showAll();
    bool anyHidden() const;
    // Only these are seen of a kind that has some; where that is so already, all are.
    void isolate(const Chosen& alone);
    void readPath();  // of the branch, from the last growth
    // Whenever the document has grown, though it be to the same plants: their seeds may have been planted anew.
    void noteGrown(bool plants);
    std::vector<EspPathSample> pathOf(uint64_t of) const;
    // What the last growth made of a seed that it got no further than; nothing: it did. Reads growth back, once after
    // each.
    std::optional<EspPlantInfo> barren(uint32_t key);
    void forgetBarren() { asked_ = {}; }  // keys are other seeds' from now on
    // False: `error` says why.
    bool readStats();
    // Whether the scene has wind.
    bool blows() const;
    // Where a point of the scene is in the window; nothing: behind the camera.
    std::optional<glm::vec2> place(glm::vec3 point) const;
    // Nothing of the scene is before the point.
    bool visible(glm::vec3 point) const;

  private:
    void seePaint(bool seen);  // over the shaded view only
    std::vector<glm::vec3> seenHouses() const;
    std::vector<glm::vec3> seenGround() const;
    uint32_t gesture_ = 0;
    std::optional<Ray> pointer_;  // that `pointed` is of
    uint32_t pointedAt_ = 0;      // and after how many expansions
    struct {
        uint32_t key = 0, expansions = 0;
        std::optional<EspPlantInfo> barren;
    } asked_;  // by barren()
};

glm::vec3 vec(const float* v);
glm::vec3 vec(const std::array<float, 3>& v);
std::array<float, 3> array(glm::vec3 v);
// Two directions that lie in the plane across `normal`.
void tangents(glm::vec3 normal, glm::vec3& u, glm::vec3& v);

}  // namespace sample
