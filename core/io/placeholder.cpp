// Until the first source of this folder lands.
namespace adamas {}
