// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/compose.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "coordinator/composite/eyes.h"
#include "coordinator/composite/mean.h"
#include "coordinator/composite/place.h"
#include "fabric/depth_merge.h"

namespace eyrie::compound {
namespace {

using fabric::Image;
using fabric::ImageView;
using fabric::LentImage;
using fabric::PixelViewport;

bool isByDepth(Combine combine) {
    return combine == Combine::Nearer || combine == Combine::NearerOrEqual;
}

/// What is in a framebuffer. Outside `image` there is background.
struct Layer {
    PixelViewport area;
    LentImage image;

    bool isEmpty() const { return image.isEmpty(); }
};

class Composer {
public:
    Composer(const Plan& plan, std::vector<LentImage> drawn, fabric::Rgba background)
        : plan_(plan),
          drawn_(std::move(drawn)),
          background_(background),
          frames_(plan.frames),
          takers_(plan.frames, 0),
          lastStep_(plan.framebuffers.size(), 0),
          showings_(plan.framebuffers.size(), 0) {
        assert(drawn_.size() == plan.draws.size());
        for (const Framebuffer& each : plan.framebuffers) layers_.push_back({each.area, {}});
        for (std::size_t i = 0; i < plan.steps.size(); ++i)
            std::visit([&](const auto& each) { count(each, i); }, plan.steps[i]);
        for (const Picture& picture : plan.pictures)
            for (const std::vector<PicturePart>* const parts : {&picture.parts, &picture.right})
                for (const PicturePart& part : *parts) ++showings_[part.framebuffer];
    }

    std::vector<Image> compose() {
        for (; now_ < plan_.steps.size(); ++now_)
            std::visit([this](const auto& each) { carryOut(each); }, plan_.steps[now_]);
        std::vector<Image> pictures;
        for (const Picture& picture : plan_.pictures) pictures.push_back(show(picture));
        return pictures;
    }

private:
    template <typename Any>
    void count(const Any& step, std::size_t index) {
        lastStep_[step.framebuffer] = index;
        if constexpr (std::is_same_v<Any, Assemble>)
            ++takers_[step.frame];
        if constexpr (std::is_same_v<Any, Average>)
            for (const std::size_t sample : step.samples) lastStep_[sample] = index;
    }

    /// Whether nobody looks at a framebuffer after this step.
    bool isDone(std::size_t framebuffer) const {
        return lastStep_[framebuffer] == now_ && showings_[framebuffer] == 0;
    }

    void carryOut(const Clear& step) {
        Layer& layer = layers_[step.framebuffer];
        if (step.part.contains(layer.image.area()))
            layer.image = {};
        else
            fill(step.part, layer);
    }

    void carryOut(const Draw& step) {
        const PixelViewport& part = plan_.draws[step.draw].task.pixelViewport;
        combine(std::move(drawn_[step.draw]), part, step.combine, layers_[step.framebuffer]);
    }

    void carryOut(const ReadBack& step) {
        Layer& layer = layers_[step.framebuffer];
        LentImage& frame = frames_[step.frame];
        const bool hasWhatIsNeeded = layer.image.hasDepth() || !step.withDepth;
        if (step.zoom)
            frame = composite::zoomed(cut(layer, step.part, step.withDepth), *step.zoom);
        else if (isDone(step.framebuffer) && hasWhatIsNeeded &&
                 step.part.contains(layer.image.area()))
            frame = std::exchange(layer.image, {});
        else
            frame = cut(layer, intersection(step.part, layer.image.area()), step.withDepth);
    }

    void carryOut(const Assemble& step) {
        LentImage frame =
            --takers_[step.frame] == 0 ? std::move(frames_[step.frame]) : frames_[step.frame];
        Layer& layer = layers_[step.framebuffer];
        if (step.regriddings.empty() && step.fromX == 0 && step.fromY == 0)
            return combine(cropped(std::move(frame), step.part), step.part, step.combine, layer);
        if (frame.isEmpty() && isByDepth(step.combine))
            return;  // nothing was drawn, which is behind all
        place(step, framed(frame.view(), step.part, step.part, frame.hasDepth()), layer);
    }

    void carryOut(const Average& step) {
        const std::size_t first = step.samples.front();
        // Where nothing was drawn there is no depth either, but background by depth.
        const bool withDepth = isByDepth(step.combine) || layers_[first].image.hasDepth();
        std::vector<Image> samples;
        for (const std::size_t each : step.samples)
            samples.push_back(cut(layers_[each], step.part, withDepth && each == first));
        combine(composite::mean(samples), step.part, step.combine, layers_[step.framebuffer]);
    }

    /// A part of what is there, background included.
    Image cut(const Layer& layer, const PixelViewport& part, bool withDepth) const {
        if (part.isEmpty())
            return {};
        if (layer.image.area().contains(part) && layer.image.hasDepth() >= withDepth)
            return copied(layer.image.view(), part, withDepth);
        Image image = fabric::makeImage(part, background_, withDepth);
        pastePart(layer.image.view(), image);
        return image;
    }

    /// Row by row, without a background to fill first.
    static Image copied(const ImageView& source, const PixelViewport& part, bool withDepth) {
        Image image{part, {}, {}};
        const auto pixels = static_cast<std::size_t>(part.area());
        image.colour.reserve(pixels);
        image.depth.reserve(withDepth ? pixels : 0);
        for (int y = part.y; y < part.y + part.height; ++y) {
            const auto from = offset(source, part.x, y);
            const auto colour = source.colour.begin() + from;
            image.colour.insert(image.colour.end(), colour, colour + part.width);
            if (withDepth)
                image.depth.insert(image.depth.end(), source.depth.begin() + from,
                                   source.depth.begin() + from + part.width);
        }
        return image;
    }

    /// As much of `source` as falls on `within` and `area`, and all of `area` that is left as
    /// background. Row by row: no pixel is written twice.
    Image framed(const ImageView& source, const PixelViewport& within, const PixelViewport& area,
                 bool withDepth) const {
        const PixelViewport part = intersection(intersection(source.area, within), area);
        if (part.isEmpty())
            return fabric::makeImage(area, background_, withDepth);
        const std::vector<fabric::Rgba> colour(static_cast<std::size_t>(area.width), background_);
        const std::vector<float> depth(withDepth ? colour.size() : 0, 0.0F);
        Image image{area, {}, {}};
        image.colour.reserve(static_cast<std::size_t>(area.area()));
        image.depth.reserve(withDepth ? static_cast<std::size_t>(area.area()) : 0);
        const bool copiesDepth = withDepth && source.hasDepth();
        for (int y = area.y; y < area.y + area.height; ++y) {
            const bool isInside = y >= part.y && y < part.y + part.height;
            const std::ptrdiff_t from = isInside ? offset(source, part.x, y) : 0;
            appendRow(isInside ? &source.colour[from] : nullptr, part, colour, area, image.colour);
            appendRow(isInside && copiesDepth ? &source.depth[from] : nullptr, part, depth, area,
                      image.depth);
        }
        return image;
    }

    /// A row of `area`: as much as `part` has of it `from` there, if that is not null, in `empty`.
    template <typename T>
    static void appendRow(const T* from, const PixelViewport& part, const std::vector<T>& empty,
                          const PixelViewport& area, std::vector<T>& row) {
        if (from == nullptr || empty.empty()) {
            row.insert(row.end(), empty.begin(), empty.end());
            return;
        }
        const std::ptrdiff_t before = part.x - area.x;
        row.insert(row.end(), empty.begin(), empty.begin() + before);
        row.insert(row.end(), from, from + part.width);
        row.insert(row.end(), empty.begin() + before + part.width, empty.end());
    }

    static LentImage cropped(LentImage frame, const PixelViewport& part) {
        if (part.contains(frame.area()))
            return frame;
        return copied(frame.view(), intersection(frame.area(), part), frame.hasDepth());
    }

    /// As much of `source` as falls on `target`.
    static void pastePart(const ImageView& source, Image& target) {
        pastePart(source, target.area, target);
    }

    /// And as falls on `within`, a part of the target.
    static void pastePart(const ImageView& source, const PixelViewport& within, Image& target) {
        const PixelViewport part = intersection(source.area, within);
        const bool withDepth = source.hasDepth() && target.hasDepth();
        for (int y = part.y; y < part.y + part.height; ++y) {
            const auto from = offset(source, part.x, y);
            const auto to = offset(target, part.x, y);
            std::copy_n(source.colour.begin() + from, part.width, target.colour.begin() + to);
            if (withDepth)
                std::copy_n(source.depth.begin() + from, part.width, target.depth.begin() + to);
        }
    }

    static std::ptrdiff_t offset(const ImageView& image, int x, int y) {
        return static_cast<std::ptrdiff_t>(y - image.area.y) * image.area.width +
               (x - image.area.x);
    }

    void fill(const PixelViewport& part, Layer& layer) const {
        const PixelViewport both = intersection(part, layer.image.area());
        if (!both.isEmpty())
            pastePart(fabric::makeImage(both, background_, layer.image.hasDepth()),
                      layer.image.own());
    }

    /// `image` lies within `part`; there is background where it has nothing.
    void combine(LentImage image, const PixelViewport& part, Combine how, Layer& layer) const {
        if (how == Combine::Replace)
            fill(part, layer);
        if (image.isEmpty())
            return;
        if (layer.isEmpty()) {
            layer.image = std::move(image);
            return;
        }
        makeRoom(image.area(), layer);
        Image& target = layer.image.own();
        takeDepth(image.view(), target);
        if (isByDepth(how) && image.hasDepth() && target.hasDepth())
            fabric::mergeDepth(
                image.view(), target,
                how == Combine::Nearer ? fabric::Ties::Target : fabric::Ties::Source);
        else
            fabric::paste(image.view(), target);
    }

    /// Where depth comes to what has none, nobody needs that of what was there.
    static void takeDepth(const ImageView& image, Image& target) {
        if (image.hasDepth())
            target.depth.resize(target.colour.size(), 0);
    }

    /// A framebuffer that gets more than it began with gets all of its area at once.
    void makeRoom(const PixelViewport& part, Layer& layer) const {
        if (layer.image.area().contains(part))
            return;
        layer.image = framed(layer.image.view(), layer.image.area(), enclosing(layer.area, part),
                             layer.image.hasDepth());
    }

    void place(const Assemble& step, Image frame, Layer& layer) const {
        PixelViewport part = step.regriddings.empty()
                                 ? layer.area
                                 : intersection(step.regriddings.front().of, layer.area);
        if (step.within)
            part = intersection(part, *step.within);
        if (part.isEmpty())
            return;
        if (layer.isEmpty())
            layer.image = fabric::makeImage(part, background_, frame.hasDepth());
        makeRoom(part, layer);
        Image& target = layer.image.own();
        takeDepth(frame, target);
        frame.area.x -= step.fromX;
        frame.area.y -= step.fromY;
        const bool byDepth = isByDepth(step.combine) && frame.hasDepth() && target.hasDepth();
        const composite::Placing placing = !byDepth ? composite::Placing::Paste
                                           : step.combine == Combine::Nearer
                                               ? composite::Placing::Nearer
                                               : composite::Placing::NearerOrEqual;
        composite::place(
            frame,
            composite::tapsBehind(step.regriddings, composite::Axis::Columns, part.x, part.width),
            composite::tapsBehind(step.regriddings, composite::Axis::Rows, part.y, part.height),
            part, placing, target);
    }

    Image show(const Picture& picture) {
        if (picture.stereo == Stereo::Separate)
            return seen(picture, picture.parts);
        const Image left = seen(picture, picture.parts);
        const Image right = seen(picture, picture.right);
        switch (picture.stereo) {
            case Stereo::SideBySide:
                return composite::sideBySide(left, right);
            case Stereo::TopBottom:
                return composite::topBottom(left, right);
            default:
                return composite::anaglyph(left, maskOf(picture.leftMask), right,
                                           maskOf(picture.rightMask));
        }
    }

    static composite::Mask maskOf(const config::ColourMask& mask) {
        return {mask.red, mask.green, mask.blue};
    }

    /// One eye's picture. What is all of it becomes it: nothing to fill, nothing to copy.
    Image seen(const Picture& picture, const std::vector<PicturePart>& parts) {
        if (parts.size() == 1 && isAllOf(picture, parts.front())) {
            Image image = std::move(layers_[parts.front().framebuffer].image.own());
            image.area = picture.area;
            if (!picture.withDepth)
                image.depth.clear();
            return image;
        }
        if (parts.size() == 1 && showings_[parts.front().framebuffer] == 1)
            return only(parts.front(), picture);
        Image image = fabric::makeImage(picture.area, background_, picture.withDepth);
        for (const PicturePart& part : parts) {
            Image shown = cut(layers_[part.framebuffer], part.part, picture.withDepth);
            shown.area.x = part.x;
            shown.area.y = part.y;
            pastePart(shown, image);
        }
        return image;
    }

    /// What nobody looks at afterwards, on a background.
    Image only(const PicturePart& part, const Picture& picture) const {
        ImageView shown = layers_[part.framebuffer].image.view();
        shown.area.x += part.x - part.part.x;
        shown.area.y += part.y - part.part.y;
        const PixelViewport within{part.x, part.y, part.part.width, part.part.height};
        return framed(shown, within, picture.area, picture.withDepth);
    }

    bool isAllOf(const Picture& picture, const PicturePart& part) const {
        const LentImage& image = layers_[part.framebuffer].image;
        return showings_[part.framebuffer] == 1 && image.area() == part.part &&
               part.part.width == picture.area.width && part.part.height == picture.area.height &&
               (image.hasDepth() || !picture.withDepth);
    }

    const Plan& plan_;
    std::vector<LentImage> drawn_;
    fabric::Rgba background_;
    std::vector<Layer> layers_;
    std::vector<LentImage> frames_;
    std::vector<std::size_t> takers_;    ///< of frames, who have not had them yet
    std::vector<std::size_t> lastStep_;  ///< that has to do with a framebuffer
    std::vector<std::size_t> showings_;  ///< of framebuffers, in pictures
    std::size_t now_ = 0;                ///< step
};

}  // namespace

std::vector<Image> composePictures(const Plan& plan, std::vector<LentImage> drawn,
                                   fabric::Rgba background) {
    return Composer(plan, std::move(drawn), background).compose();
}

}  // namespace eyrie::compound
