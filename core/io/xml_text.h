#pragma once

#include <string>

namespace adamas {

/// A name as the value of an XML attribute: markup and control characters as references, bytes that are not
/// UTF-8 taken for Latin-1, characters that XML does not know as '?'. (VTK's writers put names into files as
/// they are.)
std::string xml_attribute(const std::string& name);

}  // namespace adamas
