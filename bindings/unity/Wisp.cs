// Wisp for C# and for Unity: a thin cover of the C ABI (include/wisp/wisp.h), one file to copy into Assets/ beside the
// native library (Assets/Plugins: libwisp.so, wisp.dll, libwisp.dylib). Calls of a frame allocate nothing: the caller
// owns the arrays. An object may be used by one thread at a time.
//
//     var model = Model.Read("flame.wisp");
//     var bank = new Bank(model, capacity: 100);
//     ulong flame = bank.Spawn();
//     bank.SetCommonInputs(wind);                       // every frame
//     bank.Advance(Time.deltaTime);
//     bank.Polyline(flame, points);                     // x, y in turn
using System;
using System.IO;
using System.Runtime.InteropServices;
using System.Text;

namespace Wisp
{
    /// <summary>An error of the library, with its message.</summary>
    public sealed class WispException : Exception
    {
        public readonly int Status;

        public WispException(int status, string message) : base(message)
        {
            Status = status;
        }
    }

    internal static class Native
    {
#if (UNITY_IOS || UNITY_WEBGL) && !UNITY_EDITOR
        internal const string Library = "__Internal";
#else
        internal const string Library = "wisp";
#endif
        private const CallingConvention C = CallingConvention.Cdecl;

        [StructLayout(LayoutKind.Sequential)]
        internal struct ModelFacts
        {
            public uint Size, Inputs, Outputs, ControlPoints, Usable, Reserved;
            public double RateHz, MetresPerUnit;
            public long StepNanoseconds, MultiplyAddsPerFrame, OperationsPerFrame;
            public double BlowOutLevel, BlowOutSeconds;
            public uint Dynamics, View;
            public double HalfWidth, HalfLength, BlowOutHaste, BlowOutRecoverySeconds;
            public uint BlowOutInput, Reserved2;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Channel
        {
            public uint Size, Reserved;
            public IntPtr Name, Unit;
            public double Lowest, Highest;
            public uint SplitsSign, HasCurve;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct BankOptions
        {
            public uint Size, Capacity, PolylinePoints, Reserved;
            public ulong Seed;
            public IntPtr Memory;
            public UIntPtr MemorySize;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct BankFacts
        {
            public uint Size, Capacity, Alive, Slots, Inputs, Outputs, PolylinePoints, Reserved;
            public ulong Held, Steps;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct FlameState
        {
            public uint Size, Lit;
            public float FlameSize;
            public uint Reserved;
            public long SinceLit, SinceOut;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct WindOptions
        {
            public uint Size, Channels;
            public double RateHz, FrameRateHz, Exponent, SmoothingSeconds, FloorRiseDbPerSecond, FirstGustRms;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Recipe
        {
            public uint Size, Kind;
            public int Na, Nb, Nk, Modes;
            public IntPtr Event, Name;
        }

        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_version();
        [DllImport(Library, CallingConvention = C)] internal static extern IntPtr wisp_last_error();
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_load(byte[] bytes, UIntPtr size, out IntPtr model);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_model_free(IntPtr model);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_facts(IntPtr model, ref ModelFacts facts);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_input(IntPtr model, uint index, ref Channel channel);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_output(IntPtr model, uint index, ref Channel channel);
        [DllImport(Library, CallingConvention = C)] internal static extern IntPtr wisp_model_name(IntPtr model);
        [DllImport(Library, CallingConvention = C)] internal static extern BankOptions wisp_bank_default_options();
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_create(IntPtr model, ref BankOptions options, out IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_bank_free(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_facts(IntPtr bank, ref BankFacts facts);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_spawn(IntPtr bank, out ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_spawn_stream(IntPtr bank, ulong stream, out ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_end(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_alive(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_inputs(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_common_inputs(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_instance_inputs(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_noise(IntPtr bank, float scale);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_step(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_advance(IntPtr bank, long nanoseconds, out int steps);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_outputs(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_instance_outputs(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_polylines(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_polyline(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_flame_state(IntPtr bank, ulong instance, ref FlameState state);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_relight(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_extinguish(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern WindOptions wisp_wind_default_options();
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_create(ref WindOptions options, out IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_wind_free(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_feed(IntPtr wind, float[] samples, UIntPtr count, [Out] WindFrame[] frames, UIntPtr room, out UIntPtr taken, out UIntPtr made);

        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_create(double rateHz, out IntPtr recording);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_recording_free(IntPtr recording);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_add(IntPtr recording, uint role, byte[] name, byte[] unit, double[] samples, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_set_episodes(IntPtr recording, long[] ids, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern Recipe wisp_recipe_default(uint kind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_learn(IntPtr[] recordings, UIntPtr count, ref Recipe recipe, IntPtr progress, IntPtr of, out IntPtr fit);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_fit_free(IntPtr fit);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_fit_get_model(IntPtr fit, out IntPtr bytes, out UIntPtr size);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_fit_usable(IntPtr fit);
        [DllImport(Library, CallingConvention = C)] internal static extern IntPtr wisp_fit_reason(IntPtr fit);

        internal static byte[] Utf8(string text)
        {
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        internal static void Check(int status)
        {
            if (status != 0) throw new WispException(status, Text(wisp_last_error()));
        }

        internal static string Text(IntPtr utf8)
        {
            int length = 0;
            while (Marshal.ReadByte(utf8, length) != 0) ++length;
            var bytes = new byte[length];
            Marshal.Copy(utf8, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        internal static UIntPtr Count(Array values)
        {
            return (UIntPtr)(ulong)values.Length;
        }
    }

    /// <summary>The meaning of a model's outputs.</summary>
    public enum View { Plain = 0, Outline = 1, Pose = 2, Position = 3 }

    /// <summary>The kind of dynamics.</summary>
    public enum Dynamics { Arx = 1, Chain = 2, Switched = 3 }

    /// <summary>Name and range of an input or output.</summary>
    public struct Channel
    {
        public string Name, Unit;
        public double Lowest, Highest;
    }

    /// <summary>A model. Its banks stay valid after it is disposed.</summary>
    public sealed class Model : IDisposable
    {
        internal IntPtr Handle;
        private Native.ModelFacts facts;

        /// <summary>From the bytes of a .wisp file (in Unity: a TextAsset's bytes, of a file NAME.wisp.bytes).</summary>
        public Model(byte[] bytes)
        {
            Native.Check(Native.wisp_model_load(bytes, Native.Count(bytes), out Handle));
            facts.Size = (uint)Marshal.SizeOf(typeof(Native.ModelFacts));
            Native.Check(Native.wisp_model_get_facts(Handle, ref facts));
        }

        public static Model Read(string path)
        {
            return new Model(File.ReadAllBytes(path));
        }

        public int Inputs { get { return (int)facts.Inputs; } }
        public int Outputs { get { return (int)facts.Outputs; } }
        public int ControlPoints { get { return (int)facts.ControlPoints; } }
        public bool Usable { get { return facts.Usable != 0; } }
        public double RateHz { get { return facts.RateHz; } }
        public View View { get { return (View)facts.View; } }
        public Dynamics Dynamics { get { return (Dynamics)facts.Dynamics; } }
        public string Name { get { return Native.Text(Native.wisp_model_name(Handle)); } }

        public Channel Input(int index)
        {
            Native.Channel channel = Empty();
            Native.Check(Native.wisp_model_get_input(Handle, (uint)index, ref channel));
            return Named(channel);
        }

        public Channel Output(int index)
        {
            Native.Channel channel = Empty();
            Native.Check(Native.wisp_model_get_output(Handle, (uint)index, ref channel));
            return Named(channel);
        }

        private static Native.Channel Empty()
        {
            return new Native.Channel { Size = (uint)Marshal.SizeOf(typeof(Native.Channel)) };
        }

        private static Channel Named(Native.Channel from)
        {
            return new Channel { Name = Native.Text(from.Name), Unit = Native.Text(from.Unit), Lowest = from.Lowest, Highest = from.Highest };
        }

        public void Dispose()
        {
            Native.wisp_model_free(Handle);
            Handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Model() { Native.wisp_model_free(Handle); }
    }

    /// <summary>Living instances of one model, stepped together. Bulk arrays have a row for each slot.</summary>
    public sealed class Bank : IDisposable
    {
        private IntPtr handle;

        public Bank(Model model, int capacity = 1, ulong seed = 1, int polylinePoints = 32)
        {
            Native.BankOptions options = Native.wisp_bank_default_options();
            options.Capacity = (uint)capacity;
            options.Seed = seed;
            options.PolylinePoints = (uint)polylinePoints;
            Native.Check(Native.wisp_bank_create(model.Handle, ref options, out handle));
        }

        public int Slots { get { return (int)Facts().Slots; } }
        public int Alive { get { return (int)Facts().Alive; } }
        public int PolylinePoints { get { return (int)Facts().PolylinePoints; } }

        private Native.BankFacts Facts()
        {
            var facts = new Native.BankFacts { Size = (uint)Marshal.SizeOf(typeof(Native.BankFacts)) };
            Native.Check(Native.wisp_bank_get_facts(handle, ref facts));
            return facts;
        }

        /// <summary>Starts an instance. The lower half of its id is its slot.</summary>
        public ulong Spawn()
        {
            ulong instance;
            Native.Check(Native.wisp_bank_spawn(handle, out instance));
            return instance;
        }

        /// <summary>Starts an instance with a given random stream: the same stream and inputs give the same play.</summary>
        public ulong Spawn(ulong stream)
        {
            ulong instance;
            Native.Check(Native.wisp_bank_spawn_stream(handle, stream, out instance));
            return instance;
        }

        public void End(ulong instance) { Native.Check(Native.wisp_bank_end(handle, instance)); }
        public bool IsAlive(ulong instance) { return Native.wisp_bank_alive(handle, instance) != 0; }

        /// <summary>Sets inputs from the next step on: slots x inputs; one row for all; one instance's.</summary>
        public void SetInputs(float[] values) { Native.Check(Native.wisp_bank_set_inputs(handle, values, Native.Count(values))); }
        public void SetCommonInputs(params float[] values) { Native.Check(Native.wisp_bank_set_common_inputs(handle, values, Native.Count(values))); }
        public void SetInputs(ulong instance, float[] values) { Native.Check(Native.wisp_bank_set_instance_inputs(handle, instance, values, Native.Count(values))); }

        /// <summary>Scale of the noise: 1 as learned, 0 none.</summary>
        public void SetNoise(float scale) { Native.Check(Native.wisp_bank_set_noise(handle, scale)); }

        public void Step() { Native.Check(Native.wisp_bank_step(handle)); }

        /// <summary>Advances by a time such as Time.deltaTime. Returns the number of steps.</summary>
        public int Advance(double seconds)
        {
            int steps;
            Native.Check(Native.wisp_bank_advance(handle, (long)(seconds * 1e9), out steps));
            return steps;
        }

        /// <summary>Writes outputs into an array of slots x outputs, or one instance's.</summary>
        public void Outputs(float[] values) { Native.Check(Native.wisp_bank_outputs(handle, values, Native.Count(values))); }
        public void Outputs(ulong instance, float[] values) { Native.Check(Native.wisp_bank_instance_outputs(handle, instance, values, Native.Count(values))); }

        /// <summary>Writes outlines as x, y, x, y, …: slots x points x 2, or one instance's.</summary>
        public void Polylines(float[] values) { Native.Check(Native.wisp_bank_polylines(handle, values, Native.Count(values))); }
        public void Polyline(ulong instance, float[] values) { Native.Check(Native.wisp_bank_polyline(handle, instance, values, Native.Count(values))); }

        /// <summary>Whether an instance burns; for models with extinction only.</summary>
        public bool IsLit(ulong instance)
        {
            var state = new Native.FlameState { Size = (uint)Marshal.SizeOf(typeof(Native.FlameState)) };
            Native.Check(Native.wisp_bank_get_flame_state(handle, instance, ref state));
            return state.Lit != 0;
        }

        public void Relight(ulong instance) { Native.Check(Native.wisp_bank_relight(handle, instance)); }
        public void Extinguish(ulong instance) { Native.Check(Native.wisp_bank_extinguish(handle, instance)); }

        public void Dispose()
        {
            Native.wisp_bank_free(handle);
            handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Bank() { Native.wisp_bank_free(handle); }
    }

    /// <summary>The wind during one frame of sound: wisp_wind_frame.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct WindFrame
    {
        public long Index;
        public float Rms, RmsClean, Level, Speed, Wind, Confidence, Background, Clipped;
    }

    /// <summary>Converts a microphone's samples (OnAudioFilterRead, Microphone) to wind, a model's input.</summary>
    public sealed class WindLevel : IDisposable
    {
        private readonly WindFrame[] frames = new WindFrame[64];
        private IntPtr handle;

        public WindLevel(double rateHz, int channels = 1, double frameRateHz = 60)
        {
            Native.WindOptions options = Native.wisp_wind_default_options();
            options.RateHz = rateHz;
            options.Channels = (uint)channels;
            options.FrameRateHz = frameRateHz;
            Native.Check(Native.wisp_wind_create(ref options, out handle));
        }

        /// <summary>The latest frame.</summary>
        public WindFrame Latest { get; private set; }

        /// <summary>Takes interleaved samples, full scale +-1. Returns the number of completed frames.</summary>
        public int Feed(float[] samples)
        {
            UIntPtr taken, made;
            int all = 0;
            float[] block = samples;
            while (true)
            {
                Native.Check(Native.wisp_wind_feed(handle, block, Native.Count(block), frames, Native.Count(frames), out taken, out made));
                int count = (int)made, used = (int)taken;
                if (count > 0) Latest = frames[count - 1];
                all += count;
                if (used == block.Length) return all;
                var rest = new float[block.Length - used];  // only for more than 64 frames in one block
                Array.Copy(block, used, rest, 0, rest.Length);
                block = rest;
            }
        }

        public void Dispose()
        {
            Native.wisp_wind_free(handle);
            handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~WindLevel() { Native.wisp_wind_free(handle); }
    }
    /// <summary>The role of a channel.</summary>
    public enum Role { Input = 0, Output = 1, Motion = 2 }

    /// <summary>The recipe, as in wisp.h.</summary>
    public enum Recipe { Arx = 1, Outline = 2, Flame = 3, Chain = 4, Leaf = 5, Flicker = 6 }

    /// <summary>A recording: channels of one rate and length. NaN is a missing sample.</summary>
    public sealed class Recording : IDisposable
    {
        internal IntPtr Handle;

        public Recording(double rateHz) { Native.Check(Native.wisp_recording_create(rateHz, out Handle)); }

        public void Add(Role role, string name, double[] samples, string unit = "")
        {
            Native.Check(Native.wisp_recording_add(Handle, (uint)role, Native.Utf8(name), Native.Utf8(unit), samples, Native.Count(samples)));
        }

        /// <summary>The episode of each row; no history crosses from one episode to the next.</summary>
        public void SetEpisodes(long[] ids) { Native.Check(Native.wisp_recording_set_episodes(Handle, ids, Native.Count(ids))); }

        public void Dispose()
        {
            Native.wisp_recording_free(Handle);
            Handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Recording() { Native.wisp_recording_free(Handle); }
    }

    /// <summary>A fit: the bytes of a model's file, and its verdict. Learning takes seconds: run it in an editor or on its own
    /// thread. A library built without learning throws EntryPointNotFoundException.</summary>
    public sealed class Fit
    {
        public readonly byte[] Bytes;
        public readonly bool Usable;
        public readonly string Reason;

        /// <summary>na, nb and nk (-1: estimated) apply to Recipe.Arx; the defaults are the library's.</summary>
        public Fit(Recipe recipe, Recording[] recordings, int? na = null, int? nb = null, int? nk = null)
        {
            Native.Recipe chosen = Native.wisp_recipe_default((uint)recipe);
            chosen.Na = na ?? chosen.Na;
            chosen.Nb = nb ?? chosen.Nb;
            chosen.Nk = nk ?? chosen.Nk;
            IntPtr fit, bytes;
            UIntPtr size;
            IntPtr[] handles = Array.ConvertAll(recordings, recording => recording.Handle);
            Native.Check(Native.wisp_learn(handles, Native.Count(handles), ref chosen, IntPtr.Zero, IntPtr.Zero, out fit));
            GC.KeepAlive(recordings);
            try
            {
                Native.Check(Native.wisp_fit_get_model(fit, out bytes, out size));
                Bytes = new byte[(int)size];
                Marshal.Copy(bytes, Bytes, 0, Bytes.Length);
                Usable = Native.wisp_fit_usable(fit) != 0;
                Reason = Native.Text(Native.wisp_fit_reason(fit));
            }
            finally
            {
                Native.wisp_fit_free(fit);
            }
        }
    }
}
