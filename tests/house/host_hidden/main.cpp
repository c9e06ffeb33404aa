int play_in_game(int argc, char** argv);

int main(int argc, char** argv) { return play_in_game(argc, argv); }
