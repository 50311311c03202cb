#pragma once

// The wavefront behind straightSkeleton(), over any number type. All edges move inwards at once, each by its own speed;
// its corners draw the arcs. Three things happen: an edge shrinks to nothing, a reflex corner meets an edge and splits
// or joins loops, and two loops' sides lie on each other and close. Events of one moment are taken one after the other,
// each with a node of its own, and leave arcs of no length between them: so any order of a tie gives a plane graph,
// and the caller drops what has no length.

#include <queue>
#include <vector>

#include "runtime/roof/skeleton.hpp"

namespace espalier {

template <class T>
struct Vec {
    T x, y;
    friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec operator*(T s, Vec a) { return {s * a.x, s * a.y}; }
    friend T dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
    friend T cross(Vec a, Vec b) { return a.x * b.y - a.y * b.x; }
};

template <class T>
class Wavefront {
  public:
    struct Tolerance {
        T length;    // metres: positions nearer than this meet
        T parallel;  // sine of the angle below which edges count as parallel
    };

    Wavefront(const SkeletonInput& input, Tolerance tolerance, Skeleton& out, uint64_t& work);
    bool run();

  private:
    struct Line {  // dot(normal, p) = offset + speed * t
        Vec<T> along, normal;
        T offset, speed;
    };
    struct Corner {
        int previous, next;  // in its loop
        int left, right;     // faces: of the side that ends here, of the side that begins here
        Vec<T> start, velocity;
        T born;
        uint32_t node;
        bool alive, reflex;
        T searched;           // splits up to this time are in the pool, or were looked at
        int candidate, last;  // those still to be looked at, in the pool
        bool waiting;         // one of them is in the queue
    };
    enum class Kind { shrink, split, stop };
    struct Event {
        T time;
        Kind kind;
        int corner, other;  // shrink: the side's ends; split: the corner and the face it meets
        bool operator<(const Event& b) const { return time > b.time || (time == b.time && corner > b.corner); }
    };

    struct Meeting {
        T time;
        int face;
        bool operator<(const Meeting& b) const { return time < b.time || (time == b.time && face < b.face); }
    };

    Vec<T> at(const Corner& c, T time) const { return c.start + (time - c.born) * c.velocity; }
    // A line, and where a corner moves in the time looked at, in doubles.
    struct NearLine {
        Vec<double> normal;
        double offset, speed;
    };
    struct Reach {
        Vec<double> start, velocity;
        double born, least, longest;  // from its birth
    };
    static constexpr bool kHigh = sizeof(T) > sizeof(double);

    void addLine(const Line& line);
    Reach reachOf(const Corner& c, T until) const;
    bool beyond(const Reach& reach, int face) const;
    Line lineThrough(Vec<T> a, Vec<T> b, T speed) const;
    uint32_t addNode(Vec<T> p, T time);
    void addArc(uint32_t from, uint32_t to, int left, int right);
    int addCorner(int left, int right, Vec<T> start, uint32_t node);
    uint32_t end(int corner, Vec<T>* where = nullptr);
    void link(int a, int b);
    bool setOff(int corner);
    void start(int corner);
    void close(int a, int b);
    void slide(int corner);
    T shrinkTime(int corner) const;
    void scheduleShrink(int corner);
    void scheduleSplit(int corner);
    void findSplits(int corner, T horizon);
    void shrink(int a, int b);
    void split(int corner, int face);
    int sideHit(int corner, int face, Vec<T> p) const;
    bool sameLoop(int a, int b) const;
    void breakAll();

    const SkeletonInput& input_;
    const Tolerance tolerance_;
    Skeleton& out_;
    std::vector<Line> lines_;              // a face each
    std::vector<NearLine> nearLines_;      // likewise, where T is dear
    std::vector<std::vector<int>> sides_;  // a face each: the corners at which its sides begin or began
    std::vector<Corner> corners_;
    std::priority_queue<Event> events_;
    std::vector<Meeting> pool_;  // of reflex corners with lines, in runs sorted by time
    std::vector<Meeting> found_;
    T now_ = 0;
    int alive_ = 0;
    uint64_t& work_;  // that is left
};

}  // namespace espalier
