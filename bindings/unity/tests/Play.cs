// Plays models from C#, and compares the numbers with a table that play.cmake made by `wisp run`.
using System;
using System.Globalization;
using System.IO;
using Wisp;

internal static class Play
{
    private static void Expect(bool held, string what)
    {
        if (!held) throw new InvalidOperationException(what);
    }

    // Compares three flames at a wind of 0.5 with the table of `wisp run`: the wind, then all outputs.
    private static void Numbers(string path, string table)
    {
        using (var model = Model.Read(path))
        using (var bank = new Bank(model, 3, 5))
        {
            for (int k = 0; k < 3; ++k) bank.Spawn();
            var outputs = new float[3 * model.Outputs];
            bank.SetCommonInputs(0.5f);
            int frames = 0;
            foreach (string row in File.ReadAllLines(table))
            {
                if (row.StartsWith("#") || row.Contains(":")) continue;
                bank.Step();
                bank.Outputs(outputs);
                string[] cells = row.Split(',');
                Expect(cells.Length > outputs.Length, "a row of " + cells.Length);  // columns: the wind, the outputs, the lit flags
                for (int k = 0; k < outputs.Length; ++k)
                    Expect((float)double.Parse(cells[k + 1], CultureInfo.InvariantCulture) == outputs[k], "frame " + frames + ": " + outputs[k] + ", wisp run has " + cells[k + 1]);
                ++frames;
            }
            Console.WriteLine("C# under mono plays the numbers of wisp run: " + frames + " frames of three flames");
            Expect(frames == 200, "200 frames");
        }
    }

    private static void Life(string path)
    {
        var model = Model.Read(path);
        Expect(model.View == View.Outline && model.Dynamics == Dynamics.Arx && model.Name.Length > 0, "the model's facts");
        Expect(model.ControlPoints * 2 == model.Outputs && model.Inputs == 1, "its sizes");
        Expect(model.Input(0).Name == "wind" && model.Output(1).Name == "p0.y", "its channels");
        var bank = new Bank(model, 2, 1, 16);
        model.Dispose();
        ulong flame = bank.Spawn(), other = bank.Spawn(7);
        Expect(bank.Alive == 2 && bank.Slots == 2 && bank.PolylinePoints == 16, "the bank's facts");
        Expect(bank.Advance(1.0) > 0, "time passes");
        var outline = new float[32];
        bank.Polyline(flame, outline);
        Expect(outline[1] < 0.5 && Math.Abs(outline[17]) > 0.5, "an outline that stands on its base");
        bank.SetInputs(flame, new[] { 9f });
        for (int frame = 0; frame < 120; ++frame) bank.Step();
        Expect(!bank.IsLit(flame) && bank.IsLit(other), "strong wind puts one out");
        bank.Relight(flame);
        Expect(bank.IsLit(flame), "it is lit again");
        bank.End(other);
        Expect(!bank.IsAlive(other) && bank.IsAlive(flame), "one ends");
        try
        {
            bank.SetCommonInputs(1, 2);
            Expect(false, "two inputs were taken for one");
        }
        catch (WispException error)
        {
            Expect(error.Status == 1 && error.Message.Contains("expected 1"), "its sentence: " + error.Message);
        }
        try
        {
            new Model(new byte[] { 1, 2, 3 });
            Expect(false, "three bytes were taken for a model");
        }
        catch (WispException error)
        {
            Expect(error.Status == 2, error.Message);
        }
        bank.Dispose();
    }

    // Two seconds of a room: white noise of this peak-to-peak amplitude.
    private static float[] Room(float size)
    {
        var block = new float[2 * 48000];
        uint word = 1;
        for (int k = 0; k < block.Length; ++k)
        {
            word = word * 1664525u + 1013904223u;
            block[k] = size * ((word >> 8) / 16777216f - 0.5f);
        }
        return block;
    }

    private static void Sound()
    {
        var wind = new WindLevel(48000, 1, 60);
        int frames = wind.Feed(Room(0.001f));
        Expect(frames >= 115 && frames <= 121, "two seconds of a room: " + frames + " frames");
        float room = wind.Latest.Rms;
        wind.Feed(Room(0.01f));
        Expect(wind.Latency > 0 && wind.RoomRise >= 0 && !wind.Calibrating, "what is known of the room");
        wind.Calibration = wind.Calibration;
        Expect(wind.Latest.Index > 200 && wind.Latest.Rms > 5 * room, "it is louder, " + wind.Latest.Rms);
        wind.Dispose();
    }

    // Learns the pendulum of examples/09_c_learn.c: the model leans half a metre in steady wind.
    private static void Learning()
    {
        const int rows = 2000;
        double[] wind = new double[rows], lean = new double[rows];
        uint word = 1;
        for (int t = 0; t < rows; ++t)
        {
            word = word * 1664525u + 1013904223u;
            wind[t] = Math.Sin(0.02 * t) > 0 ? 1 : 0;
            lean[t] = (t > 1 ? 1.92 * lean[t - 1] - 0.96 * lean[t - 2] : 0) + (t > 0 ? 0.02 * wind[t - 1] : 0) + 0.004 * ((word >> 8) / 16777216.0 - 0.5);
        }
        using (var recording = new Recording(30))
        {
            recording.Add(Role.Input, "wind", wind);
            recording.Add(Role.Output, "lean", lean, "m");
            var fit = new Fit(Recipe.Arx, new[] { recording }, na: 2, nb: 1);
            Expect(fit.Usable && fit.Reason.Length > 10, fit.Reason);
            using (var model = new Model(fit.Bytes))
            using (var bank = new Bank(model))
            {
                Expect(model.Output(0).Unit == "m", "its unit");
                bank.Spawn();
                bank.SetNoise(0);
                bank.SetCommonInputs(1);
                for (int t = 0; t < 300; ++t) bank.Step();
                var swing = new float[1];
                bank.Outputs(swing);
                Expect(Math.Abs(swing[0] - 0.5) < 0.01, "it leans " + swing[0]);
            }
            try
            {
                recording.Add(Role.Output, "lean", lean);
                Expect(false, "a name was taken twice");
            }
            catch (WispException error)
            {
                Expect(error.Status == 2 && error.Message.Contains("lean"), error.Message);
            }
        }
    }

    // A flame in the round leans towards the camera in a wind from behind, and has a surface.
    private static void Round(Model plane, string path)
    {
        using (var model = plane.InTheRound())
        using (var bank = new Bank(model))
        {
            ulong flame = bank.Spawn();
            bank.SetInputs(flame, new[] { 0f, 0.6f });
            for (int frame = 0; frame < 60; ++frame) bank.Step();
            var rings = new float[16 * 6];
            bank.Rings(flame, rings);
            Expect(rings[15 * 6 + 2] > 0.05f, path + ": it leans into depth");
            bank.Look(0, -1);
            var vertices = new float[16 * 8 * 6];
            var triangles = new uint[3 * (2 * 16 * 8 - 4)];
            Bank.Mesh(rings, 8, vertices);
            Bank.Triangles(16, 8, triangles);
            Expect(Math.Abs(vertices[0] - rings[0] - rings[3]) < 1e-5f && triangles[triangles.Length - 1] < 128, path + ": its surface");
            FlameState light = bank.Flame(flame);
            Expect(light.Z > 0.05f && Math.Abs(light.Kelvin - 1900) < 60 && light.Intensity > 0.5f, path + ": its light");
            Expect(light.Lit && !light.WentOut && !light.Relit, path + ": nothing happened to it");
            bank.Extinguish(flame);
            Expect(bank.Flame(flame).WentOut, path + ": it went out");
        }
    }

    // A wrong number of values is an exception, whatever the model.
    private static void WrongSizes(Model model, Bank bank, string path)
    {
        ulong first = bank.At(0);
        bool outline = model.View == View.Outline;
        foreach (int size in new[] { 0, 1, model.Inputs, model.Inputs + 1, model.Outputs - 1, model.Outputs, 3 * model.Inputs, 3 * model.Outputs, 63, 64, 192, 1000 })
        {
            var values = new float[size];
            Expect(Fine(() => bank.SetCommonInputs(values)) == (size == model.Inputs), path + ": common inputs, " + size);
            Expect(Fine(() => bank.SetInputs(first, values)) == (size == model.Inputs), path + ": inputs of one, " + size);
            Expect(Fine(() => bank.SetInputs(values)) == (size >= 3 * model.Inputs), path + ": inputs, " + size);
            Expect(Fine(() => bank.Outputs(first, values)) == (size == model.Outputs), path + ": outputs of one, " + size);
            Expect(Fine(() => bank.Outputs(values)) == (size >= 3 * model.Outputs), path + ": outputs, " + size);
            Expect(Fine(() => bank.Polyline(first, values)) == (outline && size == 64), path + ": an outline, " + size);
            Expect(Fine(() => bank.Polylines(values)) == (outline && size >= 3 * 64), path + ": outlines, " + size);
        }
    }

    // Calls for every shipped model: those of WispFlame, saving, many steps, and those that only some models accept.
    private static void Any(string path)
    {
        using (var model = Model.Read(path))
        using (var bank = new Bank(model, 4, 3))
        {
            for (int k = 0; k < 4; ++k) bank.Spawn();
            bank.End(bank.At(3));
            float[] inputs = new float[4 * model.Inputs], outputs = new float[4 * model.Outputs], again = new float[9 * model.Outputs];
            bank.SetInputs(inputs);
            Expect(bank.Advance(0.5) > 0, path + ": time passes");
            bank.Outputs(outputs);
            Expect(outputs[3 * model.Outputs] == 0, path + ": a row of capacity that is empty");
            if (model.View == View.Outline) bank.Polylines(new float[4 * 64]);
            if (Fine(() => model.InTheRound().Dispose())) Round(model, path);
            WrongSizes(model, bank, path);
            byte[] saved = bank.Save();
            bank.Step(3, null, again);
            float last = again[again.Length - 1];
            bank.Restore(saved);
            bank.Step(3, new float[9 * model.Inputs], again);
            Expect(again[again.Length - 1] == last, path + ": goes on with the same bits");
            Expect(bank.Noise() == 1 && model.Program.Length > 3 && model.Reason != null && model.Sources() != null, path + ": what it says of itself");
            ulong first = bank.At(0);
            Expect((model.Dynamics == Dynamics.Chain) == Fine(() => bank.PlaceInChain(first)), path + ": a place");
            if (model.Dynamics == Dynamics.Chain)
            {
                bank.Ground = -3;
                Expect(bank.Ground == -3f, path + ": its settings");
                bank.Ground = null;
                Expect(bank.Ground == null, path + ": no ground");
                bank.Place(first, new Body { Z = 2, Vx = 0.5f });
                Expect(bank.CanSteer == Fine(() => bank.Steer(first, 0, 0, -1, 2)), path + ": steering");
                if (bank.CanSteer) bank.Release(first);
            }
            bank.FlameSizes(new float[4]);
            bank.Reset(first);
            bank.Reset();
        }
    }

    private static bool Fine(Action call)
    {
        try
        {
            call();
            return true;
        }
        catch (WispException)
        {
            return false;
        }
    }

    private static void Main(string[] arguments)
    {
        for (int k = 3; k < arguments.Length; ++k) Any(arguments[k]);
        Console.WriteLine("C# plays " + (arguments.Length - 3) + " shipped models");
        Expect(arguments.Length > 12, "models");
        Learning();
        Life(arguments[1]);
        Sound();
        Numbers(arguments[0], arguments[2]);
    }
}
