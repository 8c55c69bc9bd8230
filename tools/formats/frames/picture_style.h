#pragma once

#include <vector>

#include "tools/formats/frames/decode_picture.h"

namespace evit::formats {

/// What some pictures of a camera say of all: the bits that they use, and whether they are the raw mosaic of
/// a colour sensor: there, neighbours differ more than pixels two apart. Pictures that cannot be read are
/// passed over.
PictureStyle StyleOf(const std::vector<StoredPicture>& samples);

}  // namespace evit::formats
