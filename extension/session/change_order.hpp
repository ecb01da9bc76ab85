// Places of a list in the order of their last change, newest first: whoever wants what changed since some
// tick walks from the front and stops at the first that is older. A change costs the same however many there
// are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus {

class ChangeOrder {
public:
    // Takes its memory here: for places 0 … most - 1, none of them in the order yet.
    explicit ChangeOrder(std::size_t most) : links_(most + 1, Link{nobody, nobody}), end_(most) {
        links_[end_] = {end_, end_};
    }

    // The place is the newest from now on.
    void touch(std::size_t place) {
        remove(place);
        const std::size_t first = links_[end_].older;
        links_[place] = {end_, first};
        links_[first].newer = place;
        links_[end_].older = place;
    }

    void remove(std::size_t place) {
        const Link link = links_[place];
        if (link.newer == nobody) {
            return;
        }
        links_[link.newer].older = link.older;
        links_[link.older].newer = link.newer;
        links_[place] = {nobody, nobody};
    }

    // for (p = newest(); p != end(); p = older(p))
    std::size_t newest() const { return links_[end_].older; }
    std::size_t older(std::size_t place) const { return links_[place].older; }
    std::size_t end() const { return end_; }

private:
    static constexpr std::size_t nobody = ~std::size_t{0};
    struct Link {
        std::size_t newer, older;
    };
    std::vector<Link> links_;  // a ring closed by the one at end_
    std::size_t end_;
};

}  // namespace tactus
