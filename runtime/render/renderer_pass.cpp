// Enters: a host's pass and a view by matrices. Leaves: what comes before the pass, and the pass' own commands. Nothing
// is hidden by the host's objects before it is drawn, as their depths aren't there yet; the depth test does it.
#include "runtime/render/renderer.hpp"

namespace espalier {

Status Renderer::prepare(Commands& commands, const DrawInputs& inputs, const PassView& pass) {
    const ViewShape shape(pass);
    DrawInputs seen = inputs;
    seen.camera = shape.camera;
    begin(inputs, pass.format);
    now_.hosted = true;
    now_.modelsToo = pass.models;
    now_.mirrored = shape.mirrored;
    now_.viewport = pass.viewport;
    const bool shaded = !pass.format.colors.empty();
    FrameRecord frame = makeFrame(seen, pass, shape);
    frame.unit = now_.roofed ? 1.0f : models_.lengthUnit();
    if (shaded) {
        if (Status s = pickDepths(shadowPass()); !s) return s;
        if (Status s = pickScene(shownView(inputs), false); !s) return s;
        if (Status s = keepShadows(commands, seen, frame); !s) return s;
    } else {
        if (Status s = pickDepths(now_.pass); !s) return s;
        anchorLook(frame, inputs.origin);
    }
    now_.meadowLevel = frame.groundLevel;
    now_.unit = frame.unit;
    now_.modelError = shape.parallel ? inputs.look.lodPixels / shape.pixelScale : 0;
    ground_.describe(frame);
    if (Status s = upload(commands, frame); !s) return s;
    frame.viewProjection = shape.culling;
    if (now_.patterned)
        if (Status s = pieces_->choose(commands, frame, inputs.look.lodPixels); !s) return s;
    models_.choose(frame, allowedModelError(inputs.look, now_.grows));
    const EmitView view = shape.parallel
                              ? parallelView(shape.culling, shape.pixelScale, inputs.look.lodPixels)
                              : perspectiveView(shape.culling, frame.eye, shape.pixelScale, inputs.look.lodPixels);
    if (now_.grows || now_.roofed)
        if (Status s = cullGrowth(commands, inputs, view); !s) return s;
    now_.prepared = true;
    return Done{};
}

void Renderer::record(Commands& inside) {
    const bool shaded = !now_.pass.colors.empty();
    const Binding shadow{shadowMap_, shadowSampler_};
    DrawPass pass(inside, "growth", now_.viewport);
    pass.mirror(now_.mirrored);
    if (now_.grows) drawTerminals(pass, !shaded);
    if (now_.roofed)
        roofs_->draw(pass, *now_.frame, shaded ? now_.scene->roof : now_.depths->roof, shaded ? &shadow : nullptr);
    if (now_.patterned)
        pieces_->draw(pass, *now_.frame, shaded ? now_.scene->piece : now_.depths->piece, shaded ? &shadow : nullptr);
    if (now_.graphed)
        graph_->draw(pass, *now_.frame, shaded ? now_.scene->graph : now_.depths->graph, shaded ? &shadow : nullptr);
    if (!now_.modelsToo) return;
    if (shaded)
        models_.draw(pass, modelsDrawn());
    else
        models_.drawDepth(pass, now_.depths->model, now_.depths->modelCut, *now_.frame, now_.modelError);
}

}  // namespace espalier
