#include "runtime/graph/node.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace espalier {

Version nextVersion() noexcept {
    static std::atomic<Version> last = 0;
    return ++last;
}

namespace graph {

Node::Node(std::vector<Node*> inputs) : inputs_(std::move(inputs)) {
    for (Node* input : inputs_) input->readers_.push_back(this);
}

Node::~Node() {
    for (Node* input : inputs_) std::erase(input->readers_, this);
}

Version Node::change() noexcept {
    const Version now = nextVersion();
    version_ = now;
    Node* waiting = nullptr;
    for (Node* node = this; node; node = waiting ? std::exchange(waiting, waiting->next_) : nullptr)
        for (Node* reader : node->readers_) {
            if (reader->version_ == now) continue;  // another way led there
            reader->version_ = now;
            reader->next_ = std::exchange(waiting, reader);
        }
    return now;
}

}  // namespace graph
}  // namespace espalier
