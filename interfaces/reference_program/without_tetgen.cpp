#include "interfaces/reference_program/answers.h"

namespace adamas::interfaces::reference {

MesherReply run_tetgen(const MesherRequest&) {
  MesherReply reply;
  reply.failure = "this build is without TetGen (ADAMAS_WITH_TETGEN=OFF)";
  return reply;
}

}  // namespace adamas::interfaces::reference
