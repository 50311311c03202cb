#pragma once

// What is made from what, and what of it has changed since somebody looked.

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace espalier {

// When something changed: a number of a clock that all nodes share. A later change has a larger number, and no two have
// the same one. So versions of different things compare, who looks at many things remembers one number, and what comes
// in the place of something else isn't taken for it. 0: before all changes.
using Version = uint64_t;

// That of a change of something that no node stands for. Any thread.
Version nextVersion() noexcept;

namespace graph {

// A thing that others are made from, or that is made from others: seeds, a grammar, a growth.
//
// Changes are pushed: change() gives all that is made from a node, over any number of steps, the version of the change.
// Nothing is worked out then. Values are pulled: who shows something asks whether it is due, makes it, and says made().
// What can't be made stays due, and its last value stands.
//
// A node stays where it is, and outlives those that are made from it. These name it when they come into being, so nodes
// can't go round in circles. Nodes that hang together belong to one thread at a time.
class Node {
  public:
    Node() = default;
    // One that is made from these.
    explicit Node(std::initializer_list<Node*> inputs) : Node(std::vector<Node*>(inputs)) {}
    explicit Node(std::vector<Node*> inputs);
    ~Node();
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;

    // It is another one from now on. Returns the version of that. Costs a step for each node that is told, and takes no
    // memory.
    Version change() noexcept;
    // Of the last change of it, or of anything that it is made from.
    Version version() const { return version_; }

    // Whether its value was never made, or something has changed since.
    bool due() const { return made_ != version_; }
    void made() { made_ = version_; }

  private:
    std::vector<Node*> inputs_, readers_;
    Node* next_ = nullptr;  // of those that change() has yet to go through
    Version version_ = nextVersion(), made_ = 0;
};

}  // namespace graph
}  // namespace espalier
