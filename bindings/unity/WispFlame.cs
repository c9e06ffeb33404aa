// A flame in Unity: put this on an object with a MeshFilter and a MeshRenderer, and drag a model (flame.wisp renamed to
// flame.wisp.bytes) into Model. Untested in Unity; Wisp.cs is tested under Mono.
#if UNITY_5_3_OR_NEWER
using UnityEngine;

[RequireComponent(typeof(MeshFilter))]
public sealed class WispFlame : MonoBehaviour
{
    public TextAsset Model;
    [Range(-3, 3)] public float Wind;
    public float Height = 0.035f;  // height of the calm flame, metres
    public int Seed = 1;

    private const int Points = 48;
    private readonly float[] outline = new float[2 * Points];
    private float[] inputs;  // the first is wind; a model from a silent clip has none
    private readonly Vector3[] corners = new Vector3[Points + 1];
    private Wisp.Model model;
    private Wisp.Bank bank;
    private ulong flame;
    private Mesh mesh;

    private void Start()
    {
        model = new Wisp.Model(Model.bytes);
        if (model.View != Wisp.View.Outline) throw new System.ArgumentException(Model.name + " is no outline; a leaf needs Wisp.Bank.Outputs");
        inputs = new float[model.Inputs];
        bank = new Wisp.Bank(model, 1, (ulong)Seed, Points);
        flame = bank.Spawn();
        mesh = new Mesh();
        mesh.MarkDynamic();
        GetComponent<MeshFilter>().mesh = mesh;
        mesh.vertices = corners;
        var fan = new int[3 * Points];
        for (int k = 0; k < Points; ++k)
        {
            fan[3 * k] = Points;
            fan[3 * k + 1] = k;
            fan[3 * k + 2] = (k + 1) % Points;
        }
        mesh.triangles = fan;
    }

    private void Update()
    {
        if (inputs.Length > 0) inputs[0] = Wind;
        bank.SetCommonInputs(inputs);
        bank.Advance(Time.deltaTime);
        bank.Polyline(flame, outline);
        var middle = Vector3.zero;
        for (int k = 0; k < Points; ++k)
        {
            corners[k] = Height * new Vector3(outline[2 * k], outline[2 * k + 1], 0);
            middle += corners[k] / Points;
        }
        corners[Points] = middle;
        mesh.vertices = corners;
        mesh.RecalculateBounds();
    }

    private void OnDestroy()
    {
        // Both are missing where Start failed.
        if (bank != null) bank.Dispose();
        if (model != null) model.Dispose();
    }
}
#endif
